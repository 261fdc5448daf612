/* Events within a step, at which it is cut, and what they change: wheels lock, are let go or caught, the train comes to
   the judging or the stop speed. */

/* Share of a step after which a positive quantity gets below zero, from its values at begin, middle and end. */
static double crossing(double begin, double middle, double end)
{
    double bend = 2.0 * (begin - 2.0 * middle + end), fall = 3.0 * begin - 4.0 * middle + end;
    return 2.0 * begin / (fall + sqrt(fall * fall - 4.0 * bend * begin)) + 1e-9; /* a little below zero */
}

/* Share of a step up to its first event: a wheel locks, is let go, or comes to the slip to be held; or the train comes
   to the judging or the stop speed. */
static double before_event(const Loop *loop, int s, const Motion *const at[4], const Stage *const stage[4],
                           const Motion *reached)
{
    const double *radius = loop->lp + RADIUS * LANES;
    double speed = loop->now.speed[s], first = 1.0, judging = loop->set.judging_speed;
    double target = speed > judging ? judging : loop->set.stop_speed;
    if (reached->speed[s] < target) first = crossing(speed - target, at[2]->speed[s] - target, reached->speed[s] - target);
    for (int l = s; l < LANES; l += STOPS) {
        double value[3];
        for (int k = 0; k < 3; k++) {
            const Stage *taken = stage[k == 0 ? 0 : k + 1];
            const Motion *moved = k == 0 ? at[0] : k == 1 ? at[2] : reached;
            double slope, limit = 0.0;
            double fast = moved->speed[s];
            if (loop->hold) limit = fast * (1.0 - held_slip(loop, l, fast, hold_place(loop, fast), &slope)) / radius[l];
            if (loop->locked[l] != 0.0 || loop->held[l] != 0.0) value[k] = taken->given[l] - taken->passed[l];
            else value[k] = moved->wheel[l] - limit;
        }
        int below = value[0] > 0.0 && (value[1] < 0.0 || value[2] < 0.0);
        double share = below ? crossing(value[0], value[1], value[2]) : 1.0;
        share = share > EVENT_SHARE ? share : EVENT_SHARE;
        first = share < first ? share : first;
    }
    return first < 1.0 - 1e-6 ? first : 1.0;
}

/* Tell whether a wheel may come to the slip to be held, or leave it, in the middle or at the end of a step. */
static INLINE int changes_hold(const Loop *loop, const Motion *middle, const Motion *end, const Stage *const stage[4])
{
    const double *radius = loop->lp + RADIUS * LANES;
    const Motion *const moved[2] = {middle, end};
    double any = 0.0;
    WIDE double slip[LANES], slope[LANES], speed[LANES];
    for (int k = 0; k < 2; k++) {
        held_slips(loop, moved[k]->speed, slip, slope);
        spread(moved[k]->speed, speed);
        EACH_LANE {
            double free = moved[k]->wheel[l] - speed[l] * (1.0 - slip[l]) / radius[l];
            double held = stage[2 + k]->given[l] - stage[2 + k]->passed[l];
            any = (loop->held[l] != 0.0 ? held : free) < 0.0 ? 1.0 : any;
        }
    }
    return any != 0.0;
}

/* Shorten the steps to their first events; tells whether any was. */
static INLINE int shorten(Loop *loop, const Motion *const at[4], const Stage *const stage[4], const Motion *reached,
                          double *next)
{
    const double judging = loop->set.judging_speed;
    double any = 0.0;
    WIDE double target[STOPS];
    EACH_STOP target[s] = at[0]->speed[s] > judging ? judging : loop->set.stop_speed;
    for (int s = 0; s < STOPS; s++) any = reached->speed[s] < target[s] ? 1.0 : any;
    for (int l = 0; l < LANES; l++) {
        int lacks = stage[2]->given[l] < stage[2]->passed[l] || stage[3]->given[l] < stage[3]->passed[l];
        any = at[2]->wheel[l] < 0.0 || reached->wheel[l] < 0.0 ? 1.0 : any;
        any = loop->locked[l] != 0.0 && lacks ? 1.0 : any;
    }
    if (any == 0.0 && !(loop->hold && changes_hold(loop, at[2], reached, stage))) return 0;
    any = 0.0;
    for (int s = 0; s < STOPS; s++) {
        double share = loop->active[s] != 0.0 ? before_event(loop, s, at, stage, reached) : 1.0;
        if (share >= 1.0) continue;
        loop->step[s] *= share;
        next[s] = loop->time[s] + loop->step[s];
        any = 1.0;
    }
    return any != 0.0;
}

/* Lock the wheels that stopped within the step. */
static INLINE void settle_locks(Loop *loop, const double *lane_step, Motion *reached)
{
    const double *inertia = loop->lp + INERTIA * LANES;
    double *lane = loop->lane;
    WIDE double speed[LANES]; /* before the step, which ends where the train comes to the judging speed */
    spread(loop->now.speed, speed);
    EACH_LANE {
        double locked = loop->locked[l], wheel = reached->wheel[l];
        lane[LOCK_TIME * LANES + l] += locked * lane_step[l];
        double judged = speed[l] > loop->set.judging_speed ? locked * lane_step[l] : 0.0;
        double length = locked != 0.0 ? loop->lock_length[l] + judged : 0.0, longest = lane[LONGEST_LOCK * LANES + l];
        lane[JUDGED_LOCK * LANES + l] += judged;
        lane[LONGEST_LOCK * LANES + l] = length > longest ? length : longest;
        loop->lock_length[l] = length;
        /* Take back the torque that the brake could not pass on since; a locked wheel may follow its pads. */
        double below = locked == 0.0 && wheel < 0.0 ? wheel : 0.0;
        lane[TORQUE * LANES + l] += inertia[l] * below;
        reached->wheel[l] = wheel - below;
        loop->locked[l] = below < 0.0 ? 1.0 : locked;
    }
}

/* The same for wheels that come to the slip that an ideal brake never exceeds. Wheels that are held are put back on it:
   where the best slip changes abruptly with the speed, they would drift away from it. */
static void settle_holds(Loop *loop, Motion *reached)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    WIDE double slip[LANES], slope[LANES];
    held_slips(loop, reached->speed, slip, slope);
    for (int l = 0; l < LANES; l++) {
        double rolling = reached->speed[l % STOPS] * (1.0 - slip[l]) / radius[l];
        if (loop->held[l] == 0.0 && (loop->locked[l] != 0.0 || reached->wheel[l] > rolling)) continue;
        loop->lane[TORQUE * LANES + l] += inertia[l] * (reached->wheel[l] - rolling);
        reached->wheel[l] = rolling;
        loop->held[l] = 1.0;
        loop->locked[l] = 0.0;
    }
}

/* Keep the largest slip above the judging speed. */
static INLINE void note_slips(Loop *loop)
{
    double judging = loop->set.judging_speed, *most = loop->lane + SLIP_MAX * LANES;
    WIDE double speed[LANES];
    spread(loop->now.speed, speed);
    EACH_LANE {
        double slip = speed[l] > judging ? loop->present.slip[l] : 0.0;
        most[l] = slip > most[l] ? slip : most[l];
    }
}
