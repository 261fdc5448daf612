/* Motion of vehicles with AXLES axles over one step; STOPS stops side by side. The closed loop follows.

   Lane a * STOPS + s is axle a of stop s; element k of a vector over lanes stands at k * LANES + lane. Every stop
   has its own time, so that its numbers do not depend on the stops beside it. Between two samples the cylinder
   pressure has a closed form; speed, states of the axles and the rest (load transfers, or the many states of a coupled
   plant, whose right-hand side is one kernel) are integrated by Runge-Kutta of order four with a step that the slope of the creep curve allows and that ends at every valve edge. Wheel lock is a state:
   a locked wheel passes on what the rail gives, until the brake gives less. What the right-hand side does not follow
   smoothly is an event, and the step is cut there: lock and release, the ends of a rail, the judging and the stop
   speed. */
#define LANES (AXLES * STOPS)
#define CHANNELS 3 /* of the irregularities of the track: vertical, lateral, cross level */
#define SHORTEST 1e-9 /* s: edges closer together than this are one */
#define BALANCED 1e-10 /* relative: torques that differ by less are equal, so that an event ends where it was found */
#define SPEED_SHARE 0.1 /* of the speed, that a step may take from it where the slope limit is one */
#define EVENT_SHARE 1e-4 /* of a step: none is cut shorter at an event of a wheel, so that time goes on */
#define RAIL 5 /* numbers of a rail, side by side in the parameter vector from FIRST_RAIL on */
#define WIDE __attribute__((aligned(64)))
#define INLINE inline __attribute__((always_inline))
#define EACH_STOP _Pragma("omp simd") for (int s = 0; s < STOPS; s++)
#define EACH_LANE _Pragma("omp simd") for (int l = 0; l < LANES; l++)

enum { TORQUE, DAMPING, BRAKE_WORK, SLIDING_WORK, DAMPING_WORK, SLIP, SLIP_SQUARED, ANGLE, LOCK_TIME, SLIP_MAX, JUDGED_LOCK,
       LONGEST_LOCK, VENTED, SWITCHES, FILLED, WATCHED, SLIP_BAND, LANE_TOTALS };
enum { DISTANCE, RESISTANCE, RESISTANCE_WORK, JUDGED, TIME, END_SPEED, SPEED_ERROR, DISTANCE_ERROR, STOP_TOTALS };
enum { GOOD, BUFFER_FULL, BAD_COMMAND };
enum { DECIDE, ACT, WATCH, DONE }; /* what a stop does when it reaches its goal */

typedef struct {
    double sample_time, longest_step, creep_rate, slope_limit, stop_speed, regularization_speed, time_limit;
    double judging_speed, record_interval;
} Settings;

typedef struct {
    WIDE double speed[STOPS];
    WIDE double wheel[AXLE_STATES * LANES]; /* and the further states of the axle */
    WIDE double rest[REST_STATES * STOPS];
    WIDE double distance[STOPS];
} Motion;

typedef struct {
    WIDE double acceleration[STOPS]; /* rates of Motion; that of the distance is its speed */
    WIDE double wheel[AXLE_STATES * LANES];
    WIDE double rest[REST_STATES * STOPS];
    WIDE double force[LANES];
    WIDE double slip[LANES];
    WIDE double damping[LANES];
    WIDE double load[LANES];
    WIDE double passed[LANES];
    WIDE double given[LANES];        /* torque of all brakes; a locked or held wheel passes on less */
    WIDE double dynamic[LANES];      /* of these the torque of the electrodynamic brake */
    WIDE double resistance[STOPS];
    WIDE double further[FURTHER * STOPS]; /* traces of coupled plants */
} Stage;

typedef struct {                /* a step of one wheelset within which a pulse of its pulse wheel came */
    double begin, length, from, to, speed_from, speed_to; /* time, angle and speed at both ends */
    double pulse;               /* angle of the pulse */
} Passing;

typedef struct {
    Settings set;
    const double *disturbance;  /* DISTURBANCES numbers per stop */
    const double *fault;        /* FAULTS numbers per lane */
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
    const double *track;        /* per stop and point: value and slope over distance of each channel, or null */
    long track_points, track_again; /* points of a stop, and the one that comes after the last */
    double track_spacing;
    double *trace;              /* of the first stop */
    long trace_rows, trace_used;
    /* from here on: the state of the loop */
    WIDE double lp[PARAMETERS * LANES], lp2[PARAMETERS * 2 * LANES]; /* the second twice, for middle and end of a step */
    #if COUPLED
    WIDE double sp[PARAMETERS * STOPS], number[NUMBERS * STOPS];
    WIDE double vehicle_fixed[VEHICLE_CONSTANTS * STOPS];
    #endif
    WIDE double stop_fixed[STOP_CONSTANTS * STOPS];        /* constants of the kernels */
    WIDE double lane_fixed[LANE_CONSTANTS * LANES];
    WIDE double window_fixed[WINDOW_CONSTANTS * 2 * LANES]; /* of the valve pattern */
    Motion now;
    Stage present;               /* at the present time */
    WIDE double contact[2 * LANES]; /* stiffness and reciprocal load there */
    WIDE double locked[LANES];
    WIDE double held[LANES];
    WIDE double dropped[LANES];  /* electrodynamic brakes that dropped out */
    WIDE double settling[LANES]; /* 1/s: rates of sliding speeds that take an exponential step, 0 of the others */
    WIDE double lock_length[LANES]; /* of the present lock, above the judging speed */
    WIDE double valve[LANES];    /* last state of the valve: 0 none yet, 1 fill, 2 vent, 3 hold */
    WIDE double start[LANES];    /* of the valve pattern, as the next six */
    WIDE double start_pressure[LANES];
    WIDE double fill_end[LANES];
    WIDE double vent_end[LANES];
    #if KINKS
    WIDE double kink[KINKS * 2 * LANES]; /* times at which the rate of the pressure jumps; of the first half only */
    #endif
    WIDE double reservoir[LANES]; /* its pressure at the start of the pattern */
    WIDE double share[LANES];        /* of its pressure that is asked of the friction brake */
    WIDE double start_level[LANES];  /* of the electrodynamic brake, and where it goes to */
    WIDE double goal_level[LANES];
    WIDE double last_filled[LANES]; /* when the present or last filling ends; 0 before the first */
    WIDE double watched[LANES];  /* the watchdog fills until the command does */
    WIDE double pressure[LANES]; /* at the present time, as the next four */
    WIDE double torque[LANES];
    WIDE double damping[LANES];
    WIDE double level[LANES];
    WIDE double filled[LANES];   /* pressure without the venting since the last command */
    WIDE double fill[LANES];     /* command that the valves follow */
    WIDE double vent[LANES];
    WIDE double estimated[STOPS]; /* train speed that the law went by at the last sample, and its integral */
    WIDE double travelled[STOPS];
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

#if COUPLED
/* Irregularities below a wheelset: cubic between the points of a table that begins on level track and repeats its end. */
static void track_below(const Loop *loop, int lane, double distance, double *out)
{
    double h = loop->track_spacing, place = (distance - loop->lp[OFFSET * LANES + lane]) / h;
    place = place > 0.0 ? place : 0.0;
    long k = (long)place, points = loop->track_points, again = loop->track_again;
    double x = place - (double)k, y = 1.0 - x;
    if (k >= points) k = again + (k - again) % (points - again);
    const double *table = loop->track + (lane % STOPS) * points * 2 * CHANNELS;
    const double *from = table + k * 2 * CHANNELS, *to = table + (k + 1 < points ? k + 1 : again) * 2 * CHANNELS;
    for (int c = 0; c < CHANNELS; c++)
        out[c * LANES + lane] = y * y * ((1.0 + 2.0 * x) * from[2 * c] + h * x * from[2 * c + 1])
            + x * x * ((1.0 + 2.0 * y) * to[2 * c] - h * y * to[2 * c + 1]);
}
#else
static inline void load_wheels(const Loop *loop, const Motion *at, double *load)
{
    loads_kernel(loop->stop_fixed, at->rest, load);
    for (int l = 0; loop->load_factor && l < LANES; l++) load[l] *= load_at(loop, l, at->distance[l % STOPS]);
}
#endif

/* Place of a speed in the table of the slips to be held. */
static inline double hold_place(const Loop *loop, double speed)
{
    return (wspd_log(speed) - loop->hold_first) / loop->hold_spacing;
}

/* The slip to be held at a speed and its place, and its slope over speed. */
static inline double held_slip(const Loop *loop, int lane, double speed, double place, double *slope)
{
    long k = (long)place;
    if (k > loop->hold_points - 2) k = loop->hold_points - 2;
    if (k < 0) k = 0;
    const double *row = loop->hold + lane * loop->hold_points + k;
    *slope = (row[1] - row[0]) / (loop->hold_spacing * speed);
    return row[0] + (place - (double)k) * (row[1] - row[0]);
}

/* The same for every lane at the speeds of the stops. */
static inline void held_slips(const Loop *loop, const double *speed, double *slip, double *slope)
{
    WIDE double place[STOPS];
    EACH_STOP place[s] = hold_place(loop, speed[s]);
    for (int l = 0; l < LANES; l++) slip[l] = held_slip(loop, l, speed[l % STOPS], place[l % STOPS], &slope[l]);
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

#if COUPLED
static INLINE void evaluate(const Loop *loop, const Motion *at, const double *time, const double *torque,
                            const double *level, const double *damping, Stage *out)
{
    WIDE double track[CHANNELS * LANES] = {0};
    for (int l = 0; loop->track && l < LANES; l++) track_below(loop, l, at->distance[l % STOPS], track);
    brakes_kernel(loop->lane_fixed, at->wheel, torque, level, out->given, out->dynamic, out->wheel + LANES);
    vehicle_kernel(loop->vehicle_fixed, at->speed, at->wheel, at->rest, out->given, loop->locked, damping, track, time,
                   out->acceleration, out->wheel, out->rest, out->force, out->slip, out->damping, out->passed, out->load,
                   out->resistance, out->further);
}
#else
static INLINE void evaluate(const Loop *loop, const Motion *at, const double *time, const double *torque,
                            const double *level, const double *damping, Stage *out)
{
    WIDE double speed[LANES];
    load_wheels(loop, at, out->load);
    spread(at->speed, speed);
    axle_kernel(loop->lane_fixed, speed, at->wheel, out->load, torque, level, loop->locked, loop->contact, damping,
                out->force, out->wheel, out->slip, out->damping, out->passed, out->given, out->dynamic);
    train_kernel(loop->stop_fixed, at->speed, out->force, at->rest, time, out->acceleration, out->resistance, out->rest);
    if (loop->hold) hold_wheels(loop, at, out);
}
#endif

/* Work out the present stage. Wheels whose brake gives less than rail or slip take are let go. */
static INLINE void observe(Loop *loop)
{
    #if !COUPLED
    WIDE double load[LANES];
    load_wheels(loop, &loop->now, load);
    contact_kernel(loop->lane_fixed, load, loop->contact);
    #endif
    for (double released = 1.0; released != 0.0;) {
        const Stage *at = &loop->present;
        evaluate(loop, &loop->now, loop->time, loop->torque, loop->level, loop->damping, &loop->present);
        released = 0.0;
        for (int l = 0; l < LANES; l++) {
            int caught = loop->locked[l] != 0.0 || loop->held[l] != 0.0, lacks = at->given[l] * (1.0 - BALANCED) < at->passed[l];
            if (caught && lacks) loop->locked[l] = loop->held[l] = 0.0, released = 1.0;
        }
    }
}

/* to = from + share * step * rates, which are those at another moment */
static INLINE void move(const Motion *from, const Motion *at, const Stage *rates, const double *step,
                        const double *lane_step, double share, Motion *to)
{
    EACH_STOP to->speed[s] = FMA(share * step[s], rates->acceleration[s], from->speed[s]);
    EACH_STOP to->distance[s] = FMA(share * step[s], at->speed[s], from->distance[s]);
    for (int k = 0; k < AXLE_STATES; k++)
        EACH_LANE {
            int j = k * LANES + l;
            to->wheel[j] = FMA(share * lane_step[l], rates->wheel[j], from->wheel[j]);
        }
    for (int k = 0; k < REST_STATES; k++)
        EACH_STOP {
            int j = k * STOPS + s;
            to->rest[j] = FMA(share * step[s], rates->rest[j], from->rest[j]);
        }
}

/* Weighted sum of the four stages. */
#define SUM(of) ((of(0) + of(3)) + 2.0 * (of(1) + of(2)))

/* Add a step to the integrals, with the stages and weights of the states. */
static INLINE void integrate(Loop *loop, const Motion *const at[4], const Stage *const stage[4],
                             const double *lane_step)
{
    double *lane = loop->lane, *stop = loop->stop;
    const double *radius = loop->lp + RADIUS * LANES, judging = loop->set.judging_speed;
    WIDE double speed[4][LANES], begin[LANES];
    for (int k = 0; k < 4; k++) spread(at[k]->speed, speed[k]);
    EACH_LANE begin[l] = speed[0][l] > judging ? 1.0 : 0.0; /* no step goes across the judging speed */
    EACH_LANE {
        double part = lane_step[l] * (1.0 / 6.0), judged = begin[l] * part;
        #define PASSED(k) stage[k]->passed[l]
        #define DAMPED(k) stage[k]->damping[l]
        #define BRAKED(k) stage[k]->passed[l] * at[k]->wheel[l]
        #define SLID(k) stage[k]->force[l] * (speed[k][l] - radius[l] * at[k]->wheel[l])
        #define DAMPED_WORK(k) stage[k]->damping[l] * at[k]->wheel[l]
        #define SLIPPED(k) stage[k]->slip[l]
        #define SLIPPED_SQUARED(k) stage[k]->slip[l] * stage[k]->slip[l]
        #define TURNING(k) at[k]->wheel[l]
        lane[TORQUE * LANES + l] += part * SUM(PASSED);
        lane[DAMPING * LANES + l] += 2.0 * part * SUM(DAMPED);
        lane[BRAKE_WORK * LANES + l] += part * SUM(BRAKED);
        lane[SLIDING_WORK * LANES + l] += 2.0 * part * SUM(SLID);
        lane[DAMPING_WORK * LANES + l] += 2.0 * part * SUM(DAMPED_WORK);
        lane[SLIP * LANES + l] += judged * SUM(SLIPPED);
        lane[SLIP_SQUARED * LANES + l] += judged * SUM(SLIPPED_SQUARED);
        lane[ANGLE * LANES + l] += part * SUM(TURNING);
    }
    EACH_STOP {
        double part = loop->step[s] * (1.0 / 6.0);
        #define SPEED(k) at[k]->speed[s]
        #define RESISTED(k) stage[k]->resistance[s]
        #define RESISTED_WORK(k) stage[k]->resistance[s] * at[k]->speed[s]
        stop[DISTANCE * STOPS + s] += part * SUM(SPEED);
        stop[RESISTANCE * STOPS + s] += part * SUM(RESISTED);
        stop[RESISTANCE_WORK * STOPS + s] += part * SUM(RESISTED_WORK);
        stop[JUDGED * STOPS + s] += at[0]->speed[s] > judging ? loop->step[s] : 0.0;
    }
}
