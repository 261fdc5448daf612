/* Exponential steps of wheels that adhere: their sliding speed settles much faster than anything else moves.

   With y the sliding speed v - R omega of a wheel and L its rate of settling, y' = L (y - y0) + n, and the method of Cox
   and Matthews (2002) integrates the first part exactly and n by Runge-Kutta of order four; with L = 0 it is the classical
   one. The train and everything else take the classical stages, and so do the wheels of a coupled plant. */
#define STEADY 0.3    /* relative: change of a rate of settling within a step, at most */
#if !COUPLED
#define SETTLED 1e-3 /* relative: a sliding speed that is off its balance by no more has settled */
#define FAST 1.0     /* step times rate of settling, from which on a step is exponential */

typedef struct {
    WIDE double rate[LANES], sliding[LANES];                    /* L and y0 */
    WIDE double decay[LANES], half[LANES];                      /* over half a step: exp and its integral */
    WIDE double first[LANES], middle[LANES], last[LANES];       /* weights of the four stages */
    WIDE double rest[3][LANES];                                 /* n of the stages */
} Exponential;

/* Rates of settling of the wheels that adhere and have settled, in stops whose steps the slope would limit. All wheels
   that slide alike slow the train together, which adds to the slope of one. */
static INLINE void settle(const Loop *loop, const double *limited, const double *speed, const double *slope,
                          double *settling)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES, *mass = loop->lp + MASS * LANES;
    const Stage *at = &loop->present;
    WIDE double stop[LANES], slowed[LANES];
    spread(limited, stop);
    spread(at->acceleration, slowed);
    EACH_LANE {
        double rate = slope[l] * (1.0 + AXLES * inertia[l] / (mass[l] * radius[l] * radius[l]));
        double sliding = speed[l] - radius[l] * loop->now.wheel[l], change = slowed[l] - radius[l] * at->wheel[l];
        double calm = fabs(change) < SETTLED * fabs(rate * sliding) ? 1.0 : 0.0;
        calm = loop->locked[l] != 0.0 || loop->held[l] != 0.0 || rate >= 0.0 ? 0.0 : calm;
        settling[l] = stop[l] * calm * rate;
    }
}

/* Work out the weights of a step; tells whether any wheel takes it exponentially. */
static INLINE int begin_exponential(const Loop *loop, const double *lane_step, Exponential *out)
{
    const double *radius = loop->lp + RADIUS * LANES;
    double any = 0.0;
    for (int l = 0; l < LANES; l++) any = lane_step[l] * loop->settling[l] < -FAST ? 1.0 : any;
    if (any == 0.0) return 0;
    WIDE double speed[LANES];
    spread(loop->now.speed, speed);
    for (int l = 0; l < LANES; l++) {
        double h = lane_step[l], z = h * loop->settling[l];
        int fast = z < -FAST;
        z = fast ? z : -FAST;
        double decay = wspd_exp(0.5 * z), whole = decay * decay;
        double one = (whole - 1.0) / z, two = (one - 1.0) / z, three = (two - 0.5) / z; /* the functions phi */
        out->rate[l] = fast ? loop->settling[l] : 0.0;
        out->sliding[l] = speed[l] - radius[l] * loop->now.wheel[l];
        out->decay[l] = decay;
        out->half[l] = h * (decay - 1.0) / z;
        out->first[l] = h * (one - 3.0 * two + 4.0 * three);
        out->middle[l] = h * 2.0 * (two - 2.0 * three);
        out->last[l] = h * (4.0 * three - two);
    }
    return 1;
}

/* Change of the sliding speeds since the beginning of a step, by the stages up to k. */
static INLINE void slide_exponential(const Loop *loop, const Motion *const at[4], const Stage *const stage[4], int k,
                                     Exponential *wheels, double *moved)
{
    const double *radius = loop->lp + RADIUS * LANES;
    WIDE double speed[LANES], slowed[LANES];
    spread(at[k]->speed, speed);
    spread(stage[k]->acceleration, slowed);
    EACH_LANE {
        double away = speed[l] - radius[l] * at[k]->wheel[l] - wheels->sliding[l];
        double rest = slowed[l] - radius[l] * stage[k]->wheel[l] - wheels->rate[l] * away;
        double first = k == 0 ? rest : wheels->rest[0][l];
        if (k < 3) wheels->rest[k][l] = rest;
        if (k < 2) moved[l] = wheels->half[l] * rest;
        if (k == 2) moved[l] = wheels->half[l] * (wheels->decay[l] * first + 2.0 * rest - first);
        if (k == 3)
            moved[l] = wheels->first[l] * first + wheels->middle[l] * (wheels->rest[1][l] + wheels->rest[2][l])
                + wheels->last[l] * rest;
    }
}

/* Put the wheels that take an exponential step where their sliding speed has moved to. */
static INLINE void place_exponential(const Loop *loop, const Exponential *wheels, const double *moved, Motion *to)
{
    const double *radius = loop->lp + RADIUS * LANES;
    WIDE double reached[LANES];
    spread(to->speed, reached);
    EACH_LANE {
        double wheel = (reached[l] - wheels->sliding[l] - moved[l]) / radius[l];
        to->wheel[l] = wheels->rate[l] != 0.0 ? wheel : to->wheel[l];
    }
}

/* End of a step: the creep force of such a wheel changes too fast for its stages, so that its impulse on the train is what
   brake and damping took and what the wheel lost. */
static INLINE void end_exponential(const Loop *loop, const Motion *const at[4], const Stage *const stage[4],
                                   const double *lane_step, Exponential *wheels, Motion *to)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES, *mass = loop->lp + MASS * LANES;
    WIDE double moved[LANES], gained[LANES], more[LANES], heavy[LANES], change[STOPS];
    slide_exponential(loop, at, stage, 3, wheels, moved);
    EACH_STOP change[s] = to->speed[s] - loop->now.speed[s];
    spread(change, gained);
    EACH_LANE {
        double part = lane_step[l] * (1.0 / 6.0), turning = inertia[l] / (radius[l] * radius[l]);
        #define FORCED(k) stage[k]->force[l]
        #define TAKEN(k) (stage[k]->passed[l] + 2.0 * stage[k]->damping[l])
        double impulse = part * SUM(TAKEN) / radius[l] + turning * (gained[l] - moved[l]);
        more[l] = wheels->rate[l] != 0.0 ? 2.0 * part * SUM(FORCED) - impulse : 0.0;
        heavy[l] = wheels->rate[l] != 0.0 ? turning : 0.0;
    }
    EACH_STOP {
        double impulse = more[s], whole = mass[s] + heavy[s];
        for (int a = 1; a < AXLES; a++) impulse += more[a * STOPS + s], whole += heavy[a * STOPS + s];
        to->speed[s] += impulse / whole;
    }
    place_exponential(loop, wheels, moved, to);
}
#endif
