/* Motion of vehicles with AXLES axles over one step; STOPS stops side by side. The closed loop follows.

   Lane a * STOPS + s is axle a of stop s; element k of a vector over lanes stands at k * LANES + lane. Every stop
   has its own time, so that its numbers do not depend on the stops beside it. Between two samples the cylinder
   pressure has a closed form; speed, states of the axles and load transfers are integrated by Runge-Kutta of order
   four with a step that the creep stiffness allows and that ends at every valve edge. Wheel lock is a state: a locked
   wheel passes on what the rail gives, until the brake gives less. A stop ends with a step that is cut at the stop
   speed. */
#define LANES (AXLES * STOPS)
#define TRANSFER_STATES (2 * TRANSFERS) /* the load transfers, then their rates */
#define SHORTEST 1e-9 /* s: edges closer together than this are one */
#define RAIL 5 /* numbers of a rail, side by side in the parameter vector from FIRST_RAIL on */
#define WIDE __attribute__((aligned(64)))
#define INLINE inline __attribute__((always_inline))
#define EACH_STOP _Pragma("omp simd") for (int s = 0; s < STOPS; s++)
#define EACH_LANE _Pragma("omp simd") for (int l = 0; l < LANES; l++)

enum { TORQUE, DAMPING, BRAKE_WORK, SLIDING_WORK, DAMPING_WORK, SLIP, SLIP_SQUARED, ANGLE, LOCK_TIME, SLIP_MAX, JUDGED_LOCK,
       LONGEST_LOCK, VENTED, SWITCHES, LANE_TOTALS };
enum { DISTANCE, RESISTANCE, RESISTANCE_WORK, JUDGED, TIME, END_SPEED, STOP_TOTALS };
enum { GOOD, BUFFER_FULL, BAD_COMMAND };
enum { DECIDE, ACT, DONE }; /* what a stop does when it reaches its goal */

typedef struct {
    double sample_time, longest_step, creep_rate, stop_speed, regularization_speed, time_limit;
    double judging_speed, record_interval;
} Settings;

typedef struct {
    WIDE double speed[STOPS];
    WIDE double wheel[AXLE_STATES * LANES]; /* and the further states of the axle */
    WIDE double transfer[TRANSFER_STATES * STOPS];
} Motion;

typedef struct {
    WIDE double acceleration[STOPS]; /* rates of Motion */
    WIDE double wheel[AXLE_STATES * LANES];
    WIDE double transfer[TRANSFER_STATES * STOPS];
    WIDE double force[LANES];
    WIDE double slip[LANES];
    WIDE double damping[LANES];
    WIDE double load[LANES];
    WIDE double passed[LANES];
    WIDE double resistance[STOPS];
} Stage;

typedef struct {                /* a step of one wheelset within which a pulse of its pulse wheel came */
    double begin, length, from, to, speed_from, speed_to; /* time, angle and speed at both ends */
    double pulse;               /* angle of the pulse */
} Passing;

typedef struct {
    Settings set;
    const double *disturbance;  /* DISTURBANCES numbers per stop */
    const uint64_t *seed;       /* of the random numbers, per stop */
    double *queue;              /* commands that wait for the dead time: fill, then vent of every lane */
    long queue_rows;
    const double *patch_start;  /* per patch and stop: positions at which the rail changes for all axles, rising */
    const double *patch_rail;   /* RAIL numbers per patch and stop */
    long patches;
    const double *load_factor;  /* relative wheel load per lane over distance, or null */
    long load_points;
    const double *load_spacing; /* per stop */
    const double *hold;         /* slip that an ideal brake never exceeds, per lane over log of speed, or null */
    long hold_points;
    double hold_first, hold_spacing;
    double *trace;              /* of the first stop */
    long trace_rows, trace_used;
    const double *gains;        /* numbers of the law */
    /* from here on: the state of the loop */
    WIDE double lp[PARAMETERS * LANES], lp2[PARAMETERS * 2 * LANES]; /* the second twice, for middle and end of a step */
    WIDE double stop_fixed[STOP_CONSTANTS * STOPS];        /* constants of the kernels */
    WIDE double lane_fixed[LANE_CONSTANTS * LANES];
    WIDE double window_fixed[WINDOW_CONSTANTS * 2 * LANES]; /* of the valve pattern */
    Motion now;
    WIDE double locked[LANES];
    WIDE double held[LANES];
    WIDE double lock_length[LANES]; /* of the present lock, above the judging speed */
    WIDE double valve[LANES];    /* last state of the valve: 0 none yet, 1 fill, 2 vent, 3 hold */
    WIDE double start[LANES];    /* of the valve pattern, as the next three */
    WIDE double start_pressure[LANES];
    WIDE double fill_end[LANES];
    WIDE double vent_end[LANES];
    WIDE double pressure[LANES]; /* at the present time, as the next two */
    WIDE double torque[LANES];
    WIDE double filled[LANES];   /* pressure without the venting since the last command */
    WIDE double fill[LANES];     /* command that the valves follow */
    WIDE double vent[LANES];
    WIDE double time[STOPS];
    WIDE double goal[STOPS];
    WIDE double step[STOPS];
    WIDE double active[STOPS];
    WIDE double lane[LANE_TOTALS * LANES];
    WIDE double stop[STOP_TOTALS * STOPS];
    double recorded, bad[3];
    double offset[LANES], counted[LANES], followed[LANES]; /* pulse wheel: start, pulses at the last sample, angle */
    Passing last[LANES], previous[LANES]; /* the last two pulses */
    long sample[STOPS], acted[STOPS], patch[LANES], steps; /* samples that were taken, commands that have acted */
    int phase[STOPS], running, timed;
} Loop;

static inline void spread(const double *restrict stop, double *restrict lane)
{
    for (int a = 0; a < AXLES; a++)
        EACH_STOP lane[a * STOPS + s] = stop[s];
}

/* Relative wheel load of a lane at a distance: linear between the points of a table, and its last value beyond. */
static double load_at(const Loop *loop, int lane, double distance)
{
    const double *row = loop->load_factor + lane * loop->load_points;
    double place = distance / loop->load_spacing[lane % STOPS];
    if (place >= (double)(loop->load_points - 1)) return row[loop->load_points - 1];
    long k = (long)place;
    row += k;
    return row[0] + (place - (double)k) * (row[1] - row[0]);
}

/* Wheel loads at a share of the step; the load transfer is that of the same moment. */
static inline void load_wheels(const Loop *loop, double share, const double *transfer, double *load)
{
    loads_kernel(loop->stop_fixed, transfer, load);
    for (int l = 0; loop->load_factor && l < LANES; l++) {
        int s = l % STOPS;
        load[l] *= load_at(loop, l, loop->stop[DISTANCE * STOPS + s] + share * loop->step[s] * loop->now.speed[s]);
    }
}

/* The slip of every lane to be held at the speeds of the stops, and its slope over speed. */
static inline void held_slips(const Loop *loop, const double *speed, double *slip, double *slope)
{
    WIDE double place[STOPS];
    EACH_STOP place[s] = (wspd_log(speed[s]) - loop->hold_first) / loop->hold_spacing;
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS;
        long k = (long)place[s];
        if (k > loop->hold_points - 2) k = loop->hold_points - 2;
        if (k < 0) k = 0;
        const double *row = loop->hold + l * loop->hold_points + k;
        slope[l] = (row[1] - row[0]) / (loop->hold_spacing * speed[s]);
        slip[l] = row[0] + (place[s] - (double)k) * (row[1] - row[0]);
    }
}

/* Wheels under an ideal brake follow the train; they pass on what that takes. */
static void hold_wheels(const Loop *loop, const Motion *at, Stage *out)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    WIDE double slip[LANES], slope[LANES];
    held_slips(loop, at->speed, slip, slope);
    for (int l = 0; l < LANES; l++) {
        if (loop->held[l] == 0.0) continue;
        double speed = at->speed[l % STOPS];
        out->wheel[l] = out->acceleration[l % STOPS] / radius[l] * (1.0 - slip[l] - speed * slope[l]);
        out->passed[l] = 2.0 * (radius[l] * out->force[l] - out->damping[l]) - inertia[l] * out->wheel[l];
    }
}

static INLINE void evaluate(const Loop *loop, double share, const Motion *at, const double *torque,
                            const double *condition, Stage *out)
{
    WIDE double speed[LANES];
    load_wheels(loop, share, at->transfer, out->load);
    spread(at->speed, speed);
    axle_kernel(loop->lane_fixed, speed, at->wheel, out->load, torque, loop->locked, condition,
                out->force, out->wheel, out->slip, out->damping, out->passed);
    train_kernel(loop->stop_fixed, at->speed, out->force, at->transfer, out->acceleration, out->resistance, out->transfer);
    if (loop->hold) hold_wheels(loop, at, out);
}

/* to = from + share * step * rates */
static INLINE void move(const Motion *from, const Stage *rates, const double *step, const double *lane_step,
                        double share, Motion *to)
{
    EACH_STOP to->speed[s] = FMA(share * step[s], rates->acceleration[s], from->speed[s]);
    for (int k = 0; k < AXLE_STATES; k++)
        EACH_LANE {
            int j = k * LANES + l;
            to->wheel[j] = FMA(share * lane_step[l], rates->wheel[j], from->wheel[j]);
        }
    for (int k = 0; k < TRANSFER_STATES; k++)
        EACH_STOP {
            int j = k * STOPS + s;
            to->transfer[j] = FMA(share * step[s], rates->transfer[j], from->transfer[j]);
        }
}

/* Weighted sum of the four stages. */
#define SUM(of) ((of(0) + of(3)) + 2.0 * (of(1) + of(2)))

/* Add a step to the integrals, with the stages and weights of the states. */
static INLINE void integrate(Loop *loop, const Motion *const at[4], const Stage *stage, const double *lane_step)
{
    double *lane = loop->lane, *stop = loop->stop;
    const double *radius = loop->lp + RADIUS * LANES, judging = loop->set.judging_speed;
    WIDE double speed[4][LANES];
    for (int k = 0; k < 4; k++) spread(at[k]->speed, speed[k]);
    EACH_LANE {
        double part = lane_step[l] * (1.0 / 6.0);
        #define PASSED(k) stage[k].passed[l]
        #define DAMPED(k) stage[k].damping[l]
        #define BRAKED(k) stage[k].passed[l] * at[k]->wheel[l]
        #define SLID(k) stage[k].force[l] * (speed[k][l] - radius[l] * at[k]->wheel[l])
        #define DAMPED_WORK(k) stage[k].damping[l] * at[k]->wheel[l]
        #define SLIPPED(k) (speed[k][l] > judging ? stage[k].slip[l] : 0.0)
        #define SLIPPED_SQUARED(k) (speed[k][l] > judging ? stage[k].slip[l] * stage[k].slip[l] : 0.0)
        #define TURNING(k) at[k]->wheel[l]
        lane[TORQUE * LANES + l] += part * SUM(PASSED);
        lane[DAMPING * LANES + l] += 2.0 * part * SUM(DAMPED);
        lane[BRAKE_WORK * LANES + l] += part * SUM(BRAKED);
        lane[SLIDING_WORK * LANES + l] += 2.0 * part * SUM(SLID);
        lane[DAMPING_WORK * LANES + l] += 2.0 * part * SUM(DAMPED_WORK);
        lane[SLIP * LANES + l] += part * SUM(SLIPPED);
        lane[SLIP_SQUARED * LANES + l] += part * SUM(SLIPPED_SQUARED);
        lane[ANGLE * LANES + l] += part * SUM(TURNING);
    }
    EACH_STOP {
        double part = loop->step[s] * (1.0 / 6.0);
        #define SPEED(k) at[k]->speed[s]
        #define RESISTED(k) stage[k].resistance[s]
        #define RESISTED_WORK(k) stage[k].resistance[s] * at[k]->speed[s]
        #define JUDGING(k) (at[k]->speed[s] > judging ? 1.0 : 0.0)
        stop[DISTANCE * STOPS + s] += part * SUM(SPEED);
        stop[RESISTANCE * STOPS + s] += part * SUM(RESISTED);
        stop[RESISTANCE_WORK * STOPS + s] += part * SUM(RESISTED_WORK);
        stop[JUDGED * STOPS + s] += part * SUM(JUDGING);
    }
}

/* Put the wheels on the rail of their place, and shorten the steps to the next change at the present speed. */
static void lay_rails(Loop *loop)
{
    int changed = 0;
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS;
        double place = loop->stop[DISTANCE * STOPS + s] - loop->lp[OFFSET * LANES + l];
        long reached = loop->patch[l];
        while (reached < loop->patches && loop->patch_start[reached * STOPS + s] <= place) reached++;
        if (reached != loop->patch[l]) {
            const double *rail = loop->patch_rail + ((reached - 1) * STOPS + s) * RAIL;
            for (int k = 0; k < RAIL; k++) loop->lp[(FIRST_RAIL + k) * LANES + l] = rail[k];
            loop->patch[l] = reached;
            changed = 1;
        }
        if (reached < loop->patches && loop->active[s] != 0.0) {
            double wait = (loop->patch_start[reached * STOPS + s] - place) / loop->now.speed[s] + 1e-9;
            if (wait < loop->step[s]) loop->step[s] = wait;
        }
    }
    if (changed) lane_constants(loop->lp, loop->lane_fixed);
}

/* Step of every stop: what the creep stiffness allows, in equal parts up to the next valve edge or goal. */
static INLINE void choose_steps(Loop *loop, double *next)
{
    const Settings *set = &loop->set;
    double per_rate = 1.0 / set->creep_rate;
    WIDE double until[STOPS];
    EACH_STOP {
        double after = loop->time[s] + SHORTEST, before = loop->goal[s] - SHORTEST, nearest = loop->goal[s];
        for (int a = 0; a < AXLES; a++) {
            double filled = loop->fill_end[a * STOPS + s], vented = loop->vent_end[a * STOPS + s];
            double edge = filled > after ? filled : 1e300, other = vented > after ? vented : 1e300;
            edge = edge < other ? edge : other;
            edge = edge < before ? edge : 1e300;
            nearest = edge < nearest ? edge : nearest;
        }
        until[s] = nearest;
    }
    EACH_STOP {
        double slow = loop->now.speed[s], span = until[s] - loop->time[s];
        slow = slow > set->regularization_speed ? slow : set->regularization_speed;
        double wanted = slow * per_rate;
        wanted = wanted < set->longest_step ? wanted : set->longest_step;
        double count = ceil(span / wanted * (1.0 - 1e-12));
        loop->step[s] = count > 1.0 ? span / count : span;
    }
    if (loop->patches > 0) lay_rails(loop);
    EACH_STOP {
        double reached = loop->time[s] + loop->step[s];
        int last = reached > until[s] - 1e-12;
        double h = last ? until[s] - loop->time[s] : loop->step[s];
        next[s] = last ? until[s] : reached;
        loop->step[s] = loop->active[s] != 0.0 ? h : 0.0;
    }
}

/* Pressure and torque in the middle and at the end of the step, and what the stages share: stiffness and damping. */
static INLINE void prepare(const Loop *loop, const double *next, double *pressure, double *torque, double *filled,
                           double *condition)
{
    WIDE double when[2 * LANES], transfer[TRANSFER_STATES * STOPS], load[LANES];
    for (int a = 0; a < AXLES; a++)
        EACH_STOP {
            when[a * STOPS + s] = loop->time[s] + 0.5 * loop->step[s];
            when[LANES + a * STOPS + s] = next[s];
        }
    actuator_kernel(loop->window_fixed, when, pressure, torque, filled);
    for (int k = 0; k < TRANSFERS; k++)
        EACH_STOP transfer[k * STOPS + s] = loop->now.transfer[k * STOPS + s]
            + 0.5 * loop->step[s] * loop->now.transfer[(TRANSFERS + k) * STOPS + s];
    load_wheels(loop, 0.5, transfer, load);
    condition_kernel(loop->lane_fixed, when, load, condition);
}

/* Lock the wheels that stopped within the step, and release those whose brake gives less than the rail. */
static INLINE void settle_locks(Loop *loop, Stage *last, const double *lane_step, const double *speed,
                                Motion *reached)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    double *lane = loop->lane, judging = loop->set.judging_speed;
    EACH_LANE {
        last->slip[l] = last->slip[l] > 1.0 ? 1.0 : last->slip[l]; /* it may turn a stopping wheel back */
        double slip = speed[l] > judging ? last->slip[l] : 0.0, most = lane[SLIP_MAX * LANES + l];
        lane[SLIP_MAX * LANES + l] = slip > most ? slip : most;
        double locked = loop->locked[l], wheel = reached->wheel[l];
        lane[LOCK_TIME * LANES + l] += locked * lane_step[l];
        double judged = speed[l] > judging ? locked * lane_step[l] : 0.0;
        double length = locked != 0.0 ? loop->lock_length[l] + judged : 0.0, longest = lane[LONGEST_LOCK * LANES + l];
        lane[JUDGED_LOCK * LANES + l] += judged;
        lane[LONGEST_LOCK * LANES + l] = length > longest ? length : longest;
        loop->lock_length[l] = length;
        double released = loop->torque[l] < 2.0 * radius[l] * last->force[l] ? 0.0 : locked;
        double below = wheel < 0.0 ? wheel : 0.0; /* take back the torque that the brake could not pass on since */
        lane[TORQUE * LANES + l] += inertia[l] * below;
        reached->wheel[l] = wheel - below;
        loop->locked[l] = below < 0.0 ? 1.0 : released;
    }
}

/* The same for wheels that come to the slip that an ideal brake never exceeds. */
static void settle_holds(Loop *loop, const Stage *last, const double *speed, Motion *reached)
{
    const double *radius = loop->lp + RADIUS * LANES, *inertia = loop->lp + INERTIA * LANES;
    WIDE double slip[LANES], slope[LANES];
    held_slips(loop, reached->speed, slip, slope);
    for (int l = 0; l < LANES; l++) {
        double rolling = speed[l] * (1.0 - slip[l]) / radius[l];
        if (loop->held[l] == 0.0 && loop->locked[l] == 0.0 && reached->wheel[l] <= rolling) {
            loop->lane[TORQUE * LANES + l] += inertia[l] * (reached->wheel[l] - rolling);
            reached->wheel[l] = rolling;
            loop->held[l] = 1.0;
        } else if (loop->held[l] != 0.0 && last->passed[l] > loop->torque[l]) {
            loop->held[l] = 0.0; /* the brake cannot give what the slip takes */
        }
    }
}

