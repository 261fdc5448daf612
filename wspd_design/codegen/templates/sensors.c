/* What the controllers see: train speed, wheel speed and torque, each with what disturbs its measurement.

   A pulse wheel gives N pulses a turn. Counted, the wheel speed is that of the whole pulses since the last sample,
   2 pi/N each, over the sample time; the rest of an angle stays for the next count, as in an incremental encoder. Timed,
   it is 2 pi/N over the time between the last two pulses, but never more than 2 pi/N over the time since the last one:
   a wheel that turned faster would have given another pulse. Before the stop the wheel turned at its first speed, and
   the angle at which it starts is drawn. */
enum { REFERENCE_FACTOR, REFERENCE_DRIFT, REFERENCE_NOISE, SPEED_NOISE, PULSE_ANGLE, TIMED, TORQUE_FACTOR, DEAD_TIME,
       SHORTEST_PULSE, LONGEST_RELEASE, RESERVOIR_PRESSURE, ACCELEROMETER_BIAS, ACCELEROMETER_NOISE, DISTURBANCES };
enum { WHEEL_FACTOR, SENSOR_LOST, STUCK, STUCK_SINCE, FAULTS }; /* of a wheelset; the second and the last are times */
enum { NOISE, PHASE }; /* what is drawn */
#define TRAIN 0 /* whose; wheelset a is 1 + a */
#define ACCELEROMETER (1 + AXLES)
#define DISTURBANCE(name, s) loop->disturbance[(name) * STOPS + (s)]
#define FAULT(name, l) loop->fault[(name) * LANES + (l)]

/* Words that belong to a sample of a stop. */
static void draw(const Loop *loop, int stop, uint64_t sample, int whose, int what, uint64_t word[4])
{
    const uint64_t counter[4] = {sample + 1, whose, what, 0};
    philox(loop->seed[stop], counter, word);
}

/* Noise of the present sample with a given root mean square. */
static double noise(const Loop *loop, int stop, int whose, double rms)
{
    uint64_t word[4];
    if (rms == 0.0) return 0.0;
    draw(loop, stop, loop->sample[stop], whose, NOISE, word);
    return rms * normal(word);
}

/* Whole pulses up to an angle. */
static double pulses(const Loop *loop, int l, double angle)
{
    return floor(angle / DISTURBANCE(PULSE_ANGLE, l % STOPS) + loop->offset[l]);
}

/* When a pulse came: the cubic through angle and speed at both ends of its step. */
static double pulse_time(const Passing *at)
{
    double h = at->length, rise = at->to - at->from, goal = at->pulse - at->from, start = h * at->speed_from;
    double square = 3.0 * rise - 2.0 * start - h * at->speed_to, cube = start + h * at->speed_to - 2.0 * rise;
    double low = 0.0, high = 1.0, x = goal / rise;
    for (int k = 0; k < 60; k++) {
        double beyond = FMA(FMA(FMA(cube, x, square), x, start), x, -goal);
        double next = x - beyond / FMA(FMA(3.0 * cube, x, 2.0 * square), x, start);
        if (fabs(next - x) < 1e-14) break;
        if (beyond < 0.0) low = x;
        else high = x;
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return FMA(x, h, at->begin);
}

/* Put every pulse wheel where it starts. */
static void start_pulses(Loop *loop)
{
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS;
        double speed = loop->now.wheel[l], angle = DISTURBANCE(PULSE_ANGLE, s), period = angle / speed;
        uint64_t word[4];
        if (angle == 0.0) continue;
        draw(loop, s, 0, 1 + l / STOPS, PHASE, word);
        loop->offset[l] = uniform(word[0]);
        loop->counted[l] = pulses(loop, l, -speed * loop->set.sample_time);
        loop->last[l] = (Passing){-2.0 * period, 2.0 * period, -2.0 * angle, 0.0, speed, speed, -loop->offset[l] * angle};
        loop->previous[l] = loop->last[l];
        loop->previous[l].pulse -= angle;
        loop->timed |= DISTURBANCE(TIMED, s) != 0.0;
    }
}

/* Keep the steps in which the last two pulses came; called at the end of a step, before its speeds are the present ones. */
static void follow_pulses(Loop *loop, const double *lane_step, const Motion *reached)
{
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS;
        double from = loop->followed[l], to = loop->lane[ANGLE * LANES + l];
        if (DISTURBANCE(TIMED, s) == 0.0) continue;
        double before = pulses(loop, l, from), now = pulses(loop, l, to), angle = DISTURBANCE(PULSE_ANGLE, s);
        Passing step = {loop->time[s], lane_step[l], from, to, loop->now.wheel[l], reached->wheel[l], 0.0};
        loop->followed[l] = to;
        if (now <= before) continue;
        loop->previous[l] = now - before < 2.0 ? loop->last[l] : step;
        if (now - before >= 2.0) loop->previous[l].pulse = (now - 1.0 - loop->offset[l]) * angle;
        loop->last[l] = step;
        loop->last[l].pulse = (now - loop->offset[l]) * angle;
    }
}

static double measured_wheel(const Loop *loop, int l)
{
    int s = l % STOPS;
    double angle = DISTURBANCE(PULSE_ANGLE, s);
    if (angle == 0.0) return loop->now.wheel[l];
    if (DISTURBANCE(TIMED, s) == 0.0)
        return (pulses(loop, l, loop->lane[ANGLE * LANES + l]) - loop->counted[l]) * angle / loop->set.sample_time;
    double last = pulse_time(&loop->last[l]), period = last - pulse_time(&loop->previous[l]);
    double since = loop->time[s] - last;
    return angle / (since > period ? since : period);
}

/* Pressure of the reservoir after all that was counted: air keeps its temperature, and none comes in. */
static double reservoir_of(const Loop *loop, int s)
{
    double pressure = DISTURBANCE(RESERVOIR_PRESSURE, s);
    for (int l = s; l < LANES; l += STOPS) pressure -= loop->lp[DRAIN * LANES + l] * loop->lane[FILLED * LANES + l];
    return pressure;
}

/* What the law of the stops that wait for it sees: train speed, wheel speed, torque, whether the speed sensor works, and
   cylinder pressure of every lane; then acceleration, demand and reservoir of every stop. */
void wspd_measure(const Loop *loop, double *restrict out)
{
    double *of_stop = out + LANE_SEEN * LANES;
    WIDE double demand[STOPS];
    demand_kernel(loop->stop_fixed, loop->time, demand);
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS, lost = loop->time[s] >= FAULT(SENSOR_LOST, l);
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        double rms = DISTURBANCE(SPEED_NOISE, s) / loop->lp[RADIUS * LANES + l];
        double wheel = measured_wheel(loop, l) * FAULT(WHEEL_FACTOR, l) + noise(loop, s, 1 + l / STOPS, rms);
        double speed = loop->now.speed[s] * DISTURBANCE(REFERENCE_FACTOR, s)
            + loop->time[s] * DISTURBANCE(REFERENCE_DRIFT, s) + noise(loop, s, TRAIN, DISTURBANCE(REFERENCE_NOISE, s));
        out[l] = speed > 0.0 ? speed : 0.0;
        out[LANES + l] = wheel > 0.0 && !lost ? wheel : 0.0;
        out[2 * LANES + l] = (loop->torque[l] + loop->present.dynamic[l]) * DISTURBANCE(TORQUE_FACTOR, s);
        out[3 * LANES + l] = lost ? 0.0 : 1.0;
        out[4 * LANES + l] = loop->pressure[l] * DISTURBANCE(TORQUE_FACTOR, s);
    }
    for (int s = 0; s < STOPS; s++) {
        if (loop->phase[s] != DECIDE || loop->time[s] < loop->goal[s]) continue;
        double along = loop->lp[GRADE_FORCE * LANES + s] / loop->lp[MASS * LANES + s];
        of_stop[s] = loop->present.acceleration[s] + along + DISTURBANCE(ACCELEROMETER_BIAS, s)
            + noise(loop, s, ACCELEROMETER, DISTURBANCE(ACCELEROMETER_NOISE, s));
        of_stop[STOPS + s] = demand[s];
        of_stop[2 * STOPS + s] = reservoir_of(loop, s);
    }
}
