/* Closed loop of vehicles with a sampled law: steps, their ends, samples, results. */

#define ROW (3 + (5 + AXLE_STATES) * AXLES + FURTHER) /* of the trace */

static void write_trace(Loop *loop)
{
    const Stage *stage = &loop->present;
    double *row = loop->trace + loop->trace_used++ * ROW;
    loop->recorded = loop->time[0];
    *row++ = loop->stop[TIME * STOPS], *row++ = loop->now.speed[0], *row++ = loop->stop[DISTANCE * STOPS];
    for (int a = 0; a < AXLES; a++) {
        row[a] = loop->now.wheel[a * STOPS];
        row[AXLES + a] = stage->slip[a * STOPS];
        row[2 * AXLES + a] = stage->passed[a * STOPS];
        row[3 * AXLES + a] = stage->load[a * STOPS];
        row[4 * AXLES + a] = stage->given[a * STOPS];
        row[5 * AXLES + a] = stage->dynamic[a * STOPS];
        for (int k = 1; k < AXLE_STATES; k++) row[(5 + k) * AXLES + a] = loop->now.wheel[k * LANES + a * STOPS];
    }
    row += (5 + AXLE_STATES) * AXLES;
    for (int k = 0; k < FURTHER; k++) row[k] = stage->further[k * STOPS];
}

/* What was filled into the cylinder since its pattern began, for good; nothing where it was let down. */
static void count_filled(Loop *loop, int l)
{
    double gained = loop->filled[l] - loop->start_pressure[l];
    loop->lane[FILLED * LANES + l] += gained > 0.0 ? gained : 0.0;
}

static void finish(Loop *loop, int stop)
{
    for (int l = stop; l < LANES; l += STOPS) count_filled(loop, l);
    loop->active[stop] = 0.0;
    loop->phase[stop] = DONE;
    loop->running--;
}

/* One Runge-Kutta step of every stop, and what happens at its end. */
static int advance(Loop *loop)
{
    Motion moved[3], reached;
    Stage further[3];
    const Motion *const at[4] = {&loop->now, &moved[0], &moved[1], &moved[2]};
    const Stage *const stage[4] = {&loop->present, &further[0], &further[1], &further[2]};
    WIDE double next[STOPS], pressure[2 * LANES], torque[2 * LANES], filled[2 * LANES], damping[2 * LANES];
    WIDE double lane_step[LANES], time[2 * STOPS], level[2 * LANES];
    #if !COUPLED
    Exponential wheels;
    #endif
    double *step = loop->step, stop_speed = loop->set.stop_speed;
    if (loop->patches > 0) lay_rails(loop);
    choose_steps(loop, next);
    for (int cuts = 0;; cuts++) { /* an event is found by interpolation, and once more */
        follow_valves(loop, next, time, pressure, torque, filled, damping, level);
        spread(step, lane_step);
        #if !COUPLED
        WIDE double slid[LANES];
        int adhering = begin_exponential(loop, lane_step, &wheels);
        #endif
        for (int k = 0; k < 3; k++) {
            int last = k == 2, later = last * LANES; /* the last stage stands at the end of the step */
            move(&loop->now, at[k], stage[k], step, lane_step, k == 2 ? 1.0 : 0.5, &moved[k]);
            #if !COUPLED
            if (adhering) slide_exponential(loop, at, stage, k, &wheels, slid), place_exponential(loop, &wheels, slid, &moved[k]);
            #endif
            evaluate(loop, &moved[k], time + last * STOPS, torque + later, level + later, damping + later, &further[k]);
        }
        #define ACCELERATION(k) stage[k]->acceleration[s]
        EACH_STOP reached.speed[s] = loop->now.speed[s] + step[s] * (1.0 / 6.0) * SUM(ACCELERATION);
        for (int k = 0; k < AXLE_STATES; k++) {
            #define TURNED(j) stage[j]->wheel[k * LANES + l]
            EACH_LANE reached.wheel[k * LANES + l] =
                loop->now.wheel[k * LANES + l] + lane_step[l] * (1.0 / 6.0) * SUM(TURNED);
        }
        #if !COUPLED
        if (adhering) end_exponential(loop, at, stage, lane_step, &wheels, &reached);
        #endif
        if (cuts == 2 || !shorten(loop, at, stage, &reached, next)) break;
    }
    for (int k = 0; k < REST_STATES; k++) {
        #define REST(j) stage[j]->rest[k * STOPS + s]
        EACH_STOP reached.rest[k * STOPS + s] = loop->now.rest[k * STOPS + s] + step[s] * (1.0 / 6.0) * SUM(REST);
    }
    integrate(loop, at, stage, lane_step);
    EACH_STOP reached.distance[s] = loop->stop[DISTANCE * STOPS + s];
    EACH_LANE {
        loop->pressure[l] = pressure[LANES + l];
        loop->torque[l] = torque[LANES + l];
        loop->filled[l] = filled[LANES + l];
        loop->damping[l] = damping[LANES + l];
        loop->level[l] = level[LANES + l];
    }
    settle_locks(loop, lane_step, &reached);
    if (loop->hold) settle_holds(loop, &reached);
    if (loop->timed) follow_pulses(loop, lane_step, &reached);
    loop->now = reached;
    for (int s = 0; s < STOPS; s++) loop->time[s] = loop->active[s] != 0.0 ? next[s] : loop->time[s];
    observe(loop);
    note_slips(loop);
    loop->steps++;
    for (int s = 0; s < STOPS; s++) {
        if (loop->active[s] == 0.0) continue;
        loop->stop[TIME * STOPS + s] += step[s];
        loop->stop[END_SPEED * STOPS + s] = loop->now.speed[s];
        if (loop->now.speed[s] <= stop_speed * (1.0 + 1e-6)) finish(loop, s);
    }
    double since = loop->time[0] - loop->recorded;
    if (loop->trace && (since >= loop->set.record_interval || (since > 0.0 && loop->active[0] == 0.0))) {
        if (loop->trace_used == loop->trace_rows) return BUFFER_FULL;
        write_trace(loop);
    }
    return GOOD;
}

/* Work out the constants of the actuators for the present valve patterns. */
static void set_windows(Loop *loop)
{
    WIDE double window[WINDOW * 2 * LANES];
    for (int copy = 0; copy < 2; copy++)
        for (int l = 0; l < LANES; l++) {
            double *to = window + copy * LANES + l;
            to[0] = loop->start[l], to[2 * LANES] = loop->start_pressure[l];
            to[4 * LANES] = loop->fill_end[l], to[6 * LANES] = loop->vent_end[l];
            to[8 * LANES] = loop->reservoir[l];
            to[10 * LANES] = loop->share[l], to[12 * LANES] = loop->start_level[l], to[14 * LANES] = loop->goal_level[l];
        }
    window_constants(loop->lp2, window, loop->window_fixed);
    #if KINKS
    kinks_kernel(loop->lp2, window, loop->kink);
    #endif
}

/* When the watchdog of a wheelset fills. */
static double watch_time(const Loop *loop, int l)
{
    double longest = DISTURBANCE(LONGEST_RELEASE, l % STOPS);
    return longest > 0.0 && loop->watched[l] == 0.0 ? loop->last_filled[l] + longest : 1e300;
}

/* What a stop does next, and when: take the next sample, follow the command that has waited longest, or see a watchdog
   fill before that. */
static void schedule(Loop *loop, int s)
{
    double h = loop->set.sample_time, sampling = loop->sample[s] * h;
    double acting = loop->acted[s] * h + DISTURBANCE(DEAD_TIME, s);
    int waiting = loop->acted[s] < loop->sample[s] && acting <= sampling;
    loop->phase[s] = waiting ? ACT : DECIDE;
    loop->goal[s] = waiting ? acting : sampling;
    for (int l = s; l < LANES; l += STOPS) {
        double watched = watch_time(loop, l);
        if (watched < loop->goal[s] - SHORTEST) loop->phase[s] = WATCH, loop->goal[s] = watched;
    }
}

/* Count the changes of the valve state that a command makes: first fill, then vent, then hold. */
static void count_switches(Loop *loop, int l)
{
    double share[3] = {loop->fill[l], loop->vent[l], 1.0 - loop->fill[l] - loop->vent[l]};
    for (int k = 0; k < 3; k++) {
        if (!(share[k] > 1e-9)) continue;
        if (loop->valve[l] != 0.0 && loop->valve[l] != k + 1) loop->lane[SWITCHES * LANES + l] += 1.0;
        loop->valve[l] = k + 1;
    }
}

/* Let the electrodynamic brake of a lane drop out when its wheel slides too much, for the rest of the stop, and ask the
   friction brake for what it lacks to the torque of the full pressure. */
static void blend(Loop *loop, int l)
{
    double most = loop->lp[MAX_TORQUE * LANES + l], rest = most > 0.0 ? 1.0 - loop->present.dynamic[l] / most : 0.0;
    if (loop->present.slip[l] > loop->lp[DROP_SLIP * LANES + l]) loop->dropped[l] = 1.0;
    loop->share[l] = rest > LEAST_SHARE ? rest : LEAST_SHARE;
    loop->start_level[l] = loop->level[l];
    loop->goal_level[l] = 1.0 - loop->dropped[l];
}

/* Close the accounts of a pattern of a wheelset and begin the next one, without its reservoir. */
static void begin_pattern(Loop *loop, int l, double present, double fill_end, double vent_end)
{
    count_filled(loop, l);
    count_switches(loop, l);
    loop->lane[VENTED * LANES + l] += loop->filled[l] - loop->pressure[l];
    loop->start[l] = present;
    loop->start_pressure[l] = loop->filled[l] = loop->pressure[l];
    loop->fill_end[l] = fill_end, loop->vent_end[l] = vent_end;
    blend(loop, l);
}

/* What the valves of a wheelset do that no longer follow commands: hold, vent or fill. */
static int stuck(const Loop *loop, int l, double *fill, double *vent)
{
    int how = loop->time[l % STOPS] >= FAULT(STUCK_SINCE, l) ? (int)FAULT(STUCK, l) : 0;
    if (how) *fill = how == 3 ? 1.0 : 0.0, *vent = how == 2 ? 1.0 : 0.0;
    return how;
}

/* Let a wheelset follow its command. A pulse that is too short to open its valve is left out, unless the valve is open
   already. A wheelset whose watchdog has filled does so until its command fills. */
static void follow_command(Loop *loop, int l, double a, double b)
{
    double h = loop->set.sample_time, present = loop->time[l % STOPS];
    double least = DISTURBANCE(SHORTEST_PULSE, l % STOPS) - SHORTEST;
    int filling = 1.0 - loop->fill[l] < 1e-12;
    int venting = !filling && 1.0 - loop->fill[l] - loop->vent[l] < 1e-12;
    if (a * h < least && !filling) a = 0.0;
    if (b * h < least && !(venting && a == 0.0)) b = 0.0;
    if (a > 0.0) loop->last_filled[l] = present + a * h, loop->watched[l] = 0.0;
    else if (loop->watched[l] != 0.0) a = 1.0, b = 0.0;
    stuck(loop, l, &a, &b);
    loop->fill[l] = a, loop->vent[l] = b;
    double fill_end = present + a * h;
    begin_pattern(loop, l, present, fill_end, 1.0 - a - b < 1e-12 ? present + h : fill_end + b * h);
}

/* Let the watchdogs fill that have waited long enough, until the next command acts. */
static void watch(Loop *loop, int s)
{
    for (int l = s; l < LANES; l += STOPS) {
        if (watch_time(loop, l) > loop->time[s] + SHORTEST) continue;
        loop->watched[l] = 1.0;
        loop->lane[WATCHED * LANES + l] += 1.0;
        double fill = 1.0, vent = 0.0, now = loop->time[s];
        stuck(loop, l, &fill, &vent);
        loop->fill[l] = fill, loop->vent[l] = vent;
        begin_pattern(loop, l, now, fill > 0.0 ? 1e300 : now, fill > 0.0 || vent > 0.0 ? 1e300 : now);
        loop->reservoir[l] = reservoir_of(loop, s);
    }
}

/* Set the valves of the stops whose command takes effect now, or whose watchdog fills. */
static void act(Loop *loop)
{
    int any = 0;
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] == ACT && loop->time[s] >= loop->goal[s]) {
            const double *command = loop->queue + loop->acted[s] % loop->queue_rows * 2 * LANES;
            for (int l = s; l < LANES; l += STOPS) follow_command(loop, l, command[l], command[LANES + l]);
            double reservoir = reservoir_of(loop, s);
            for (int l = s; l < LANES; l += STOPS) loop->reservoir[l] = reservoir;
            loop->acted[s]++;
            schedule(loop, s);
            any = 1;
        }
        if (loop->phase[s] == WATCH && loop->time[s] >= loop->goal[s]) {
            watch(loop, s);
            schedule(loop, s);
            any = 1;
        }
    }
    if (any) set_windows(loop);
}

/* Tell whether a stop waits for the decision of its controllers; end the stops that take too long. */
static int awaited(Loop *loop)
{
    int any = 0;
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        if (loop->time[s] > loop->set.time_limit) finish(loop, s);
        else any = 1;
    }
    return any;
}

/* Take the commands of the stops that wait for them. */
static int decide(Loop *loop, const double *fill, const double *vent)
{
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        double *command = loop->queue + loop->sample[s] % loop->queue_rows * 2 * LANES;
        for (int l = s; l < LANES; l += STOPS) {
            double a = fill[l], b = vent[l];
            if (!(a >= 0.0 && a <= 1.0 && b >= 0.0 && a + b <= 1.0 + 1e-9)) {
                loop->bad[0] = loop->sample[s] * loop->set.sample_time, loop->bad[1] = a, loop->bad[2] = b;
                return BAD_COMMAND;
            }
            command[l] = a, command[LANES + l] = b;
            if (DISTURBANCE(PULSE_ANGLE, s) > 0.0) loop->counted[l] = pulses(loop, l, loop->lane[ANGLE * LANES + l]);
        }
        loop->sample[s]++;
        schedule(loop, s);
    }
    return GOOD;
}

long wspd_size(void) { return (long)sizeof(Loop); }
long wspd_row(void) { return ROW; }
const double *wspd_lane_totals(const Loop *loop) { return loop->lane; }
const double *wspd_stop_totals(const Loop *loop) { return loop->stop; }
const double *wspd_wheel_speeds(const Loop *loop) { return loop->now.wheel; }
const double *wspd_bad_command(const Loop *loop) { return loop->bad; }
long wspd_steps(const Loop *loop) { return loop->steps; }
int wspd_running(Loop *loop) { return awaited(loop) && loop->running > 0; }

long wspd_samples(const Loop *loop)
{
    long most = 0;
    for (int s = 0; s < STOPS; s++) most = loop->sample[s] > most ? loop->sample[s] : most;
    return most;
}

/* Put every stop at its initial state and cylinder pressures, with closed valves. */
void wspd_begin(Loop *loop, const double *sp, const double *lp, const double *number, const double *speed,
                const double *wheel, const double *rest, const double *pressure)
{
    WIDE double present[2 * LANES] = {0}, pressures[2 * LANES], torques[2 * LANES];
    WIDE double filled[2 * LANES], damping[2 * LANES], level[2 * LANES];
    memset(loop->lp, 0, (char *)(loop + 1) - (char *)loop->lp);
    memcpy(loop->lp, lp, sizeof loop->lp);
    for (int k = 0; k < PARAMETERS; k++)
        for (int l = 0; l < 2 * LANES; l++) loop->lp2[k * 2 * LANES + l] = lp[k * LANES + l % LANES];
    stop_constants(sp, loop->stop_fixed);
    #if COUPLED
    memcpy(loop->sp, sp, sizeof loop->sp);
    memcpy(loop->number, number, sizeof loop->number);
    #else
    (void)number;
    #endif
    work_out_lanes(loop);
    memcpy(loop->now.rest, rest, sizeof loop->now.rest);
    loop->recorded = -1.0;
    loop->running = STOPS;
    for (int s = 0; s < STOPS; s++) loop->active[s] = 1.0, loop->now.speed[s] = speed[s];
    for (int l = 0; l < LANES; l++) loop->now.wheel[l] = wheel[l], loop->start_pressure[l] = pressure[l];
    for (int l = 0; l < LANES; l++) loop->reservoir[l] = DISTURBANCE(RESERVOIR_PRESSURE, l % STOPS);
    for (int l = 0; l < LANES; l++) loop->lane[SLIP_BAND * LANES + l] = -1.0;
    start_pulses(loop);
    set_windows(loop);
    actuator_kernel(loop->window_fixed, present, pressures, torques, filled, damping, level);
    for (int l = 0; l < LANES; l++) {
        loop->pressure[l] = pressures[l], loop->filled[l] = filled[l];
        loop->torque[l] = torques[l], loop->damping[l] = damping[l], loop->level[l] = level[l];
    }
    observe(loop);
    if (COUPLED && loop->trace) write_trace(loop);
    for (int s = 0; s < STOPS; s++) {
        loop->stop[END_SPEED * STOPS + s] = speed[s];
        if (speed[s] <= loop->set.stop_speed) finish(loop, s); /* at rest already */
    }
}

/* Run until a controller is asked or all stops have ended. */
static int to_next_decision(Loop *loop)
{
    int result = GOOD;
    act(loop);
    while (result == GOOD && loop->running > 0 && !awaited(loop)) {
        result = advance(loop);
        if (result == GOOD) act(loop);
    }
    return result;
}

/* Run a single stop to the next sample with the given shares of filling and venting. */
int wspd_sample(Loop *loop, const double *fill, const double *vent)
{
    int result = decide(loop, fill, vent);
    return result == GOOD ? to_next_decision(loop) : result;
}

/* Judge the train speed that a law goes by, and the slips that it holds, against the truth at a sample of the stops that
   wait for it; null for what the law does not tell. A number that is none is an error without end. */
void wspd_judge(Loop *loop, const double *speed, const double *reference)
{
    double h = loop->set.sample_time;
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        double now = loop->now.speed[s];
        if (speed) {
            double *worst = loop->stop + SPEED_ERROR * STOPS + s, *apart = loop->stop + DISTANCE_ERROR * STOPS + s;
            double passed = loop->stop[DISTANCE * STOPS + s], error = fabs(speed[s] / now - 1.0);
            if (loop->sample[s] > 0) loop->travelled[s] += 0.5 * h * (loop->estimated[s] + speed[s]);
            loop->estimated[s] = speed[s];
            double away = fabs(loop->travelled[s] - passed) / (FREE_DISTANCE + DISTANCE_SHARE * passed);
            if (now > ERROR_SPEED && !(error <= *worst)) *worst = isnan(error) ? INFINITY : error;
            if (!(away <= *apart)) *apart = isnan(away) ? INFINITY : away;
        }
        for (int l = s; reference && now > loop->set.judging_speed && l < LANES; l += STOPS) {
            double *band = loop->lane + SLIP_BAND * LANES + l, over = loop->present.slip[l] - reference[l];
            if (*band < 0.0 && !(over < 0.0)) *band = 0.0;
            if (*band >= 0.0 && !(fabs(over) <= *band)) *band = isnan(over) ? INFINITY : fabs(over);
        }
    }
}

/* A law: functions of all that it sees, its numbers, and memory for what they take and give. Element k of stop s stands
   at k * STOPS + s; what belongs to wheelsets comes front axle first. */
typedef struct {
    void (*start)(const double *seen, const double *gains, double *state);
    void (*step)(const double *state, const double *seen, const double *gains, double *next);
    const double *gains;
    long states;                 /* numbers that it remembers, of one stop */
    long speed, reference;       /* places in them of the train speed and of the slips that it holds; -1 for none */
    double *seen, *state, *next; /* next: the states to be, then fill and vent of every wheelset */
} Law;

/* Let the law see the present; 0 when all stops have ended. */
int wspd_ask(Loop *loop, const Law *law)
{
    int running = wspd_running(loop);
    if (running) wspd_measure(loop, law->seen);
    return running;
}

/* Keep what the law of a stop saw, decided and remembers. */
static void write_sample(const Loop *loop, const Law *law, int stop, double *samples)
{
    long decided = law->states + 2 * AXLES, seen = LANE_SEEN * AXLES + STOP_SEEN;
    double *row = samples + loop->sample[stop] * (1 + (decided + seen) * STOPS);
    *row++ = loop->sample[stop] * loop->set.sample_time;
    for (long k = 0; k < decided; k++) row[k * STOPS + stop] = law->next[k * STOPS + stop];
    for (long k = 0; k < seen; k++) row[(decided + k) * STOPS + stop] = law->seen[k * STOPS + stop];
}

/* Take what the law decided for the waiting stops, and run to the next decision. ``samples`` may be null. */
int wspd_answer(Loop *loop, const Law *law, double *samples, long sample_rows)
{
    const double *command = law->next + law->states * STOPS;
    if (samples && wspd_samples(loop) == sample_rows) return BUFFER_FULL;
    wspd_judge(loop, law->speed < 0 ? 0 : law->next + law->speed * STOPS,
               law->reference < 0 ? 0 : law->next + law->reference * STOPS);
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        if (samples) write_sample(loop, law, s, samples);
        for (long k = 0; k < law->states; k++) law->state[k * STOPS + s] = law->next[k * STOPS + s];
    }
    return wspd_sample(loop, command, command + LANES);
}

/* Run all stops with a law in C. */
int wspd_run(Loop *loop, const Law *law, double *samples, long sample_rows)
{
    int result = GOOD;
    wspd_measure(loop, law->seen);
    law->start(law->seen, law->gains, law->state);
    while (result == GOOD && wspd_ask(loop, law)) {
        law->step(law->state, law->seen, law->gains, law->next);
        result = wspd_answer(loop, law, samples, sample_rows);
    }
    return result;
}
