/* The law of all lanes as a library of its own, which closed_loop.c calls. */
void wspd_start(const double *restrict seen, const double *restrict gains, double *restrict state)
{
    start_kernel(seen, gains, state);
}

void wspd_step(const double *restrict state, const double *restrict seen, const double *restrict gains,
               double *restrict next)
{
    step_kernel(state, seen, gains, next);
}
