/* Closed loop of a four-axle vehicle with one sampled controller per wheelset; STOPS stops side by side.

   Lane a * STOPS + s is axle a of stop s; element k of a vector over lanes stands at k * LANES + lane. Between two
   samples the cylinder pressure has a closed form; speed, wheel speeds and pitch are integrated by Runge-Kutta of
   order four with a step that the creep stiffness allows and that ends at every valve edge. Wheel lock is a state: a locked wheel passes on what the
   rail gives, until the brake gives less. A stop ends with a step that is cut at the stop speed. */
#define AXLES 4
#define LANES (AXLES * STOPS)
#define PITCH 6
#define SHORTEST 1e-9 /* s: edges closer together than this are one */
#define RAIL 5 /* numbers of a rail, side by side in the parameter vector from FIRST_RAIL on */

enum { TORQUE, DAMPING, BRAKE_WORK, SLIDING_WORK, DAMPING_WORK, SLIP, SLIP_SQUARED, LOCK_TIME, SLIP_MAX, VENTED, LANE_TOTALS };
enum { DISTANCE, RESISTANCE, RESISTANCE_WORK, JUDGED, TIME, END_SPEED, STOP_TOTALS };
enum { GOOD, BUFFER_FULL, BAD_COMMAND };

typedef struct {
    double sample_time, dead_time, longest_step, creep_rate, stop_speed, regularization_speed, time_limit;
    double judging_speed, record_interval;
} Settings;

typedef struct {
    double speed[STOPS], wheel[LANES], pitch[PITCH * STOPS];
} Motion;

typedef struct {
    double acceleration[STOPS], wheel[LANES], pitch[PITCH * STOPS]; /* rates of Motion */
    double force[LANES], slip[LANES], damping[LANES], load[LANES], passed[LANES], resistance[STOPS];
} Stage;

typedef struct {
    Settings set;
    const double *measured;     /* per sample and lane: factor and offset of the wheel speed, or null */
    const double *patch_start;  /* positions at which the rail changes, rising, for all axles */
    const double *patch_rail;   /* RAIL numbers per patch and axle */
    long patches;
    const double *load_factor;  /* relative wheel load per axle over distance, or null */
    long load_points;
    double load_spacing;
    const double *hold;         /* slip that an ideal brake never exceeds, per axle over log of speed, or null */
    long hold_points;
    double hold_first, hold_spacing;
    double *trace;
    long trace_rows, trace_used;
    double quantum;             /* rad/s, resolution of the measured wheel speed; 0 for none */
    double reference_factor;    /* measured over true train speed */
    /* from here on: the state of the loop */
    double sp[PARAMETERS * STOPS], lp[PARAMETERS * LANES];
    Motion now;
    double locked[LANES], held[LANES], pressure[LANES], fill_end[LANES], vent_end[LANES], window; /* of the valve pattern */
    double torque[3 * LANES];   /* pressure, torque, and pressure before venting at the present time */
    double step[STOPS], active[STOPS], time, edge, recorded;
    double lane[LANE_TOTALS * LANES], stop[STOP_TOTALS * STOPS], bad[3];
    long sample, patch[LANES], steps;
    int running;
} Loop;

static void spread(const double *restrict stop, double *restrict lane)
{
    for (int a = 0; a < AXLES; a++)
        for (int s = 0; s < STOPS; s++) lane[a * STOPS + s] = stop[s];
}

/* Relative wheel load of a lane at a distance: linear between the points of a table. */
static double load_at(const Loop *loop, int lane, double distance)
{
    double place = distance / loop->load_spacing;
    long k = (long)place;
    if (k > loop->load_points - 2) k = loop->load_points - 2;
    const double *row = loop->load_factor + (lane / STOPS) * loop->load_points + k;
    return row[0] + (place - (double)k) * (row[1] - row[0]);
}

/* Wheel loads at a share of the step; the pitch is that of the same moment. */
static void load_wheels(const Loop *loop, double share, const double *pitch, double *load)
{
    loads_kernel(loop->sp, pitch, load);
    if (loop->load_factor)
        for (int l = 0; l < LANES; l++) {
            int s = l % STOPS;
            load[l] *= load_at(loop, l, loop->stop[DISTANCE * STOPS + s] + share * loop->step[s] * loop->now.speed[s]);
        }
}

/* Stiffness and damping of every lane in the middle of the step, which the stages share: they change slowly. */
static void prepare(const Loop *loop, double h, double *condition)
{
    double in[2 * LANES], pitch[PITCH * STOPS];
    for (int k = 0; k < PITCH / 2 * STOPS; k++)
        pitch[k] = loop->now.pitch[k] + 0.5 * h * loop->now.pitch[PITCH / 2 * STOPS + k];
    load_wheels(loop, 0.5, pitch, in + LANES);
    for (int l = 0; l < LANES; l++) in[l] = loop->time + 0.5 * h;
    condition_kernel(loop->lp, in, condition);
}

/* The slip to be held at a speed, and its slope over speed. */
static double held_slip(const Loop *loop, int lane, double speed, double *slope)
{
    double place = (wspd_log(speed) - loop->hold_first) / loop->hold_spacing;
    long k = (long)place;
    if (k > loop->hold_points - 2) k = loop->hold_points - 2;
    if (k < 0) k = 0;
    const double *row = loop->hold + (lane / STOPS) * loop->hold_points + k;
    *slope = (row[1] - row[0]) / (loop->hold_spacing * speed);
    return row[0] + (place - (double)k) * (row[1] - row[0]);
}

/* Wheels under an ideal brake follow the train; they pass on what that takes. */
static void hold_wheels(const Loop *loop, const Motion *at, Stage *out)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    for (int l = 0; l < LANES; l++) {
        if (loop->held[l] == 0.0) continue;
        double slope, speed = at->speed[l % STOPS], slip = held_slip(loop, l, speed, &slope);
        out->wheel[l] = out->acceleration[l % STOPS] / radius[l] * (1.0 - slip - speed * slope);
        out->passed[l] = 2.0 * (radius[l] * out->force[l] - out->damping[l]) - inertia[l] * out->wheel[l];
    }
}

static void evaluate(Loop *loop, double share, const Motion *at, const double *torque, const double *condition,
                     Stage *out)
{
    double in[6 * LANES], result[4 * LANES], train[(1 + AXLES + PITCH) * STOPS], rates[(2 + PITCH) * STOPS];
    load_wheels(loop, share, at->pitch, out->load);
    spread(at->speed, in);
    memcpy(in + LANES, at->wheel, sizeof at->wheel);
    memcpy(in + 2 * LANES, out->load, sizeof out->load);
    memcpy(in + 3 * LANES, torque, LANES * sizeof *torque);
    memcpy(in + 4 * LANES, condition, 2 * LANES * sizeof *condition);
    axle_kernel(loop->lp, in, result);
    memcpy(train, at->speed, sizeof at->speed);
    memcpy(train + STOPS, result, LANES * sizeof *result);
    memcpy(train + STOPS + LANES, at->pitch, sizeof at->pitch);
    train_kernel(loop->sp, train, rates);
    memcpy(out->acceleration, rates, sizeof out->acceleration);
    memcpy(out->resistance, rates + STOPS, sizeof out->resistance);
    memcpy(out->pitch, rates + 2 * STOPS, sizeof out->pitch);
    const double *radius = loop->lp + RADIUS * LANES, *locked = loop->locked;
    #pragma omp simd
    for (int l = 0; l < LANES; l++) {
        out->force[l] = result[l];
        out->wheel[l] = locked[l] != 0.0 ? 0.0 : result[LANES + l];
        out->slip[l] = result[2 * LANES + l];
        out->damping[l] = result[3 * LANES + l];
        out->passed[l] = locked[l] != 0.0 ? 2.0 * radius[l] * result[l] : torque[l];
    }
    if (loop->hold) hold_wheels(loop, at, out);
}

/* to = from + share * step * rates */
static void move(const Motion *from, const Stage *rates, const double *step, double share, Motion *to)
{
    double lane[LANES];
    spread(step, lane);
    for (int s = 0; s < STOPS; s++) to->speed[s] = from->speed[s] + share * step[s] * rates->acceleration[s];
    for (int l = 0; l < LANES; l++) to->wheel[l] = from->wheel[l] + share * lane[l] * rates->wheel[l];
    for (int k = 0; k < PITCH * STOPS; k++)
        to->pitch[k] = from->pitch[k] + share * step[k % STOPS] * rates->pitch[k];
}

/* Add one stage with its weight to the integrals. */
static void add(Loop *loop, const Motion *at, const Stage *stage, double weight)
{
    double h[LANES], speed[LANES], *lane = loop->lane, *stop = loop->stop;
    const double *radius = loop->lp + RADIUS * LANES, judging = loop->set.judging_speed;
    spread(loop->step, h);
    spread(at->speed, speed);
    #pragma omp simd
    for (int l = 0; l < LANES; l++) {
        double part = weight * h[l], judged = speed[l] > judging ? part : 0.0;
        lane[TORQUE * LANES + l] += part * stage->passed[l];
        lane[DAMPING * LANES + l] += part * 2.0 * stage->damping[l];
        lane[BRAKE_WORK * LANES + l] += part * stage->passed[l] * at->wheel[l];
        lane[SLIDING_WORK * LANES + l] += part * 2.0 * stage->force[l] * (speed[l] - radius[l] * at->wheel[l]);
        lane[DAMPING_WORK * LANES + l] += part * 2.0 * stage->damping[l] * at->wheel[l];
        lane[SLIP * LANES + l] += judged * stage->slip[l];
        lane[SLIP_SQUARED * LANES + l] += judged * stage->slip[l] * stage->slip[l];
    }
    for (int s = 0; s < STOPS; s++) {
        double part = weight * loop->step[s];
        stop[DISTANCE * STOPS + s] += part * at->speed[s];
        stop[RESISTANCE * STOPS + s] += part * stage->resistance[s];
        stop[RESISTANCE_WORK * STOPS + s] += part * stage->resistance[s] * at->speed[s];
        stop[JUDGED * STOPS + s] += at->speed[s] > judging ? part : 0.0;
    }
}

/* Pressure and torque of every lane at a time within the present valve pattern. */
static void actuate(const Loop *loop, double time, double *restrict out)
{
    double in[5 * LANES];
    for (int l = 0; l < LANES; l++) in[l] = time, in[LANES + l] = loop->window;
    memcpy(in + 2 * LANES, loop->pressure, sizeof loop->pressure);
    memcpy(in + 3 * LANES, loop->fill_end, sizeof loop->fill_end);
    memcpy(in + 4 * LANES, loop->vent_end, sizeof loop->vent_end);
    actuator_kernel(loop->lp, in, out);
}

/* Put the wheels on the rail of their place, and return the time to the next change at the present speed. */
static double lay_rails(Loop *loop)
{
    double soonest = 1e300;
    for (int l = 0; l < LANES && loop->patches > 0; l++) {
        int s = l % STOPS;
        double place = loop->stop[DISTANCE * STOPS + s] - loop->lp[OFFSET * LANES + l];
        long reached = loop->patch[l];
        while (reached < loop->patches && loop->patch_start[reached] <= place) reached++;
        if (reached != loop->patch[l]) {
            const double *rail = loop->patch_rail + ((reached - 1) * AXLES + l / STOPS) * RAIL;
            for (int k = 0; k < RAIL; k++) loop->lp[(FIRST_RAIL + k) * LANES + l] = rail[k];
            loop->patch[l] = reached;
        }
        if (reached < loop->patches && loop->active[s] != 0.0) {
            double wait = (loop->patch_start[reached] - place) / loop->now.speed[s] + 1e-9;
            if (wait < soonest) soonest = wait;
        }
    }
    return soonest;
}

/* The next edge of any valve of a moving stop. */
static double next_edge(const Loop *loop)
{
    double next = 1e300;
    for (int l = 0; l < LANES; l++) {
        if (loop->active[l % STOPS] == 0.0) continue;
        double a = loop->fill_end[l], b = loop->vent_end[l], after = loop->time + SHORTEST;
        if (a > after && a < next) next = a;
        if (b > after && b < next) next = b;
    }
    return next;
}

static double step_length(Loop *loop, double until)
{
    if (loop->edge <= loop->time + SHORTEST) loop->edge = next_edge(loop);
    if (loop->edge < until - SHORTEST) until = loop->edge;
    const Settings *set = &loop->set;
    double change = lay_rails(loop), slowest = 1e300, span = until - loop->time;
    for (int s = 0; s < STOPS; s++)
        if (loop->active[s] != 0.0 && loop->now.speed[s] < slowest) slowest = loop->now.speed[s];
    if (slowest < set->regularization_speed) slowest = set->regularization_speed;
    double wanted = slowest / set->creep_rate;
    if (wanted > set->longest_step) wanted = set->longest_step;
    double count = ceil(span / wanted * (1.0 - 1e-12)), h = count > 1.0 ? span / count : span;
    return change < h ? change : h;
}

static void write_trace(Loop *loop, const Stage *stage)
{
    double *row = loop->trace + loop->trace_used++ * (3 + 5 * LANES);
    loop->recorded = loop->time;
    *row++ = loop->stop[TIME * STOPS], *row++ = loop->now.speed[0], *row++ = loop->stop[DISTANCE * STOPS];
    for (int l = 0; l < LANES; l++) {
        row[l] = loop->now.wheel[l];
        row[LANES + l] = stage->slip[l];
        row[2 * LANES + l] = stage->passed[l];
        row[3 * LANES + l] = stage->load[l];
        row[4 * LANES + l] = loop->torque[l];
    }
}

/* One Runge-Kutta step, and what happens at its end. */
static int advance(Loop *loop, double until)
{
    Motion at[3], reached;
    Stage stage[4];
    double middle[3 * LANES], end[3 * LANES], condition[2 * LANES], lane_step[LANES], speed[LANES];
    const Settings *set = &loop->set;
    double *step = loop->step, h = step_length(loop, until), next = loop->time + h;
    if (next > until - 1e-12) next = until, h = until - loop->time;
    for (int s = 0; s < STOPS; s++) step[s] = h * loop->active[s];
    actuate(loop, loop->time + 0.5 * h, middle);
    actuate(loop, next, end);
    prepare(loop, h, condition);
    evaluate(loop, 0.0, &loop->now, loop->torque + LANES, condition, &stage[0]);
    for (int again = 1, attempt = 0; again; attempt++) {
        move(&loop->now, &stage[0], step, 0.5, &at[0]);
        evaluate(loop, 0.5, &at[0], middle + LANES, condition, &stage[1]);
        move(&loop->now, &stage[1], step, 0.5, &at[1]);
        evaluate(loop, 0.5, &at[1], middle + LANES, condition, &stage[2]);
        move(&loop->now, &stage[2], step, 1.0, &at[2]);
        evaluate(loop, 1.0, &at[2], end + LANES, condition, &stage[3]);
        again = 0;
        for (int s = 0; s < STOPS; s++) {
            double sum = stage[0].acceleration[s] + 2.0 * (stage[1].acceleration[s] + stage[2].acceleration[s])
                + stage[3].acceleration[s];
            reached.speed[s] = loop->now.speed[s] + step[s] / 6.0 * sum;
            if (attempt == 0 && loop->active[s] != 0.0 && reached.speed[s] < set->stop_speed) {
                step[s] *= (loop->now.speed[s] - set->stop_speed) / (loop->now.speed[s] - reached.speed[s]);
                again = 1; /* once more with the step that ends at the stop speed */
            }
        }
    }
    spread(step, lane_step);
    for (int l = 0; l < LANES; l++)
        reached.wheel[l] = loop->now.wheel[l] + lane_step[l] / 6.0
            * (stage[0].wheel[l] + 2.0 * (stage[1].wheel[l] + stage[2].wheel[l]) + stage[3].wheel[l]);
    for (int k = 0; k < PITCH * STOPS; k++)
        reached.pitch[k] = loop->now.pitch[k] + step[k % STOPS] / 6.0
            * (stage[0].pitch[k] + 2.0 * (stage[1].pitch[k] + stage[2].pitch[k]) + stage[3].pitch[k]);
    /* the integrals use the stages and weights of the states */
    add(loop, &loop->now, &stage[0], 1.0 / 6.0);
    add(loop, &at[0], &stage[1], 1.0 / 3.0);
    add(loop, &at[1], &stage[2], 1.0 / 3.0);
    add(loop, &at[2], &stage[3], 1.0 / 6.0);

    spread(reached.speed, speed);
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    for (int l = 0; l < LANES; l++) {
        double *most = &loop->lane[SLIP_MAX * LANES + l];
        loop->lane[LOCK_TIME * LANES + l] += loop->locked[l] * lane_step[l];
        if (stage[3].slip[l] > 1.0) stage[3].slip[l] = 1.0; /* the last stage may turn a stopping wheel back */
        if (speed[l] > set->judging_speed && stage[3].slip[l] > *most) *most = stage[3].slip[l];
        if (loop->locked[l] == 0.0 && reached.wheel[l] < 0.0) {
            /* The wheel stopped within the step: take back the torque that the brake could not pass on since. */
            loop->lane[TORQUE * LANES + l] += inertia[l] * reached.wheel[l];
            reached.wheel[l] = 0.0;
            loop->locked[l] = 1.0;
        } else if (loop->locked[l] != 0.0 && end[LANES + l] < 2.0 * radius[l] * stage[3].force[l]) {
            loop->locked[l] = 0.0;
        }
    }
    for (int l = 0; l < LANES && loop->hold; l++) {
        double slope, slip = held_slip(loop, l, speed[l], &slope), rolling = speed[l] * (1.0 - slip) / radius[l];
        if (loop->held[l] == 0.0 && loop->locked[l] == 0.0 && reached.wheel[l] <= rolling) {
            loop->lane[TORQUE * LANES + l] += inertia[l] * (reached.wheel[l] - rolling);
            reached.wheel[l] = rolling;
            loop->held[l] = 1.0;
        } else if (loop->held[l] != 0.0 && stage[3].passed[l] > end[LANES + l]) {
            loop->held[l] = 0.0; /* the brake cannot give what the slip takes */
        }
    }
    loop->now = reached;
    loop->time = next;
    loop->steps++;
    memcpy(loop->torque, end, sizeof end);
    for (int s = 0; s < STOPS; s++)
        if (loop->active[s] != 0.0) {
            loop->stop[TIME * STOPS + s] += step[s];
            loop->stop[END_SPEED * STOPS + s] = loop->now.speed[s];
            if (loop->now.speed[s] <= set->stop_speed * (1.0 + 1e-6)) loop->active[s] = 0.0, loop->running--;
        }
    if (loop->trace && (loop->time - loop->recorded >= set->record_interval || loop->running == 0)) {
        if (loop->trace_used == loop->trace_rows) return BUFFER_FULL;
        write_trace(loop, &stage[3]);
    }
    return GOOD;
}

static int advance_to(Loop *loop, double until)
{
    int result = GOOD;
    while (loop->time < until && loop->running > 0 && result == GOOD) result = advance(loop, until);
    return result;
}

long wspd_size(void) { return (long)sizeof(Loop); }
const double *wspd_lane_totals(const Loop *loop) { return loop->lane; }
const double *wspd_stop_totals(const Loop *loop) { return loop->stop; }
const double *wspd_wheel_speeds(const Loop *loop) { return loop->now.wheel; }
const double *wspd_bad_command(const Loop *loop) { return loop->bad; }
long wspd_steps(const Loop *loop) { return loop->steps; }
long wspd_samples(const Loop *loop) { return loop->sample; }
int wspd_running(const Loop *loop) { return loop->running > 0 && loop->time <= loop->set.time_limit; }

/* Put every stop at its initial speed with rolling wheels and empty cylinders. */
void wspd_begin(Loop *loop, const double *sp, const double *lp, const double *speed)
{
    double lane_speed[LANES];
    memcpy(loop->sp, sp, sizeof loop->sp);
    memcpy(loop->lp, lp, sizeof loop->lp);
    memset(&loop->now, 0, (char *)(loop + 1) - (char *)&loop->now);
    loop->recorded = -1.0;
    loop->running = STOPS;
    for (int s = 0; s < STOPS; s++) loop->active[s] = 1.0, loop->now.speed[s] = speed[s];
    spread(loop->now.speed, lane_speed);
    for (int l = 0; l < LANES; l++) loop->now.wheel[l] = lane_speed[l] / lp[RADIUS * LANES + l];
}

/* What the controllers see at the present sample: speed, wheel speed, torque of every lane. */
void wspd_measure(const Loop *loop, double *restrict out)
{
    spread(loop->now.speed, out);
    for (int l = 0; l < LANES; l++) {
        double wheel = loop->now.wheel[l];
        if (loop->measured) wheel += loop->measured[loop->sample * LANES + l];
        if (loop->quantum > 0.0) wheel = loop->quantum * floor(wheel / loop->quantum + 0.5);
        out[l] *= loop->reference_factor;
        out[LANES + l] = wheel > 0.0 ? wheel : 0.0;
        out[2 * LANES + l] = loop->torque[LANES + l];
    }
}

/* Run to the next sample with the given shares of filling and venting. */
int wspd_sample(Loop *loop, const double *fill, const double *vent)
{
    double h = loop->set.sample_time, from = loop->sample * h, to = (loop->sample + 1) * h;
    int result = advance_to(loop, from + loop->set.dead_time); /* the valves still follow the last command */
    double present = loop->time;
    actuate(loop, present, loop->torque);
    for (int l = 0; l < LANES; l++) /* a finished stop vents no more */
        if (loop->active[l % STOPS] != 0.0)
            loop->lane[VENTED * LANES + l] += loop->torque[2 * LANES + l] - loop->torque[l];
    memcpy(loop->pressure, loop->torque, sizeof loop->pressure);
    loop->window = present;
    for (int l = 0; l < LANES; l++) {
        double a = fill[l], b = vent[l];
        if (!(a >= 0.0 && a <= 1.0 && b >= 0.0 && a + b <= 1.0 + 1e-9)) {
            if (loop->active[l % STOPS] != 0.0) {
                loop->bad[0] = from, loop->bad[1] = a, loop->bad[2] = b;
                return BAD_COMMAND;
            }
            a = b = 0.0;
        }
        loop->fill_end[l] = present + a * h;
        loop->vent_end[l] = 1.0 - a - b < 1e-12 ? present + h : loop->fill_end[l] + b * h;
    }
    loop->edge = loop->time; /* that is, look for the next one */
    loop->sample++;
    return result == GOOD ? advance_to(loop, to) : result;
}

/* Run all stops with the compiled controller. ``samples`` may be null. */
int wspd_run(Loop *loop, double *samples, long sample_rows)
{
    double state[STATES * LANES + 1], command[(STATES + 2) * LANES], in[3 * LANES];
    int result = GOOD;
    wspd_measure(loop, in);
    start_kernel(in, state);
    while (wspd_running(loop) && result == GOOD) {
        wspd_measure(loop, in);
        step_kernel(state, in, command);
        memcpy(state, command, STATES * LANES * sizeof *state);
        if (samples) {
            if (loop->sample == sample_rows) return BUFFER_FULL;
            double *row = samples + loop->sample * (1 + (STATES + 5) * LANES);
            row[0] = loop->sample * loop->set.sample_time;
            memcpy(row + 1, command, sizeof command);
            memcpy(row + 1 + (STATES + 2) * LANES, in, sizeof in);
        }
        result = wspd_sample(loop, command + STATES * LANES, command + (STATES + 1) * LANES);
    }
    return result;
}
