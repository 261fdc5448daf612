/* How long a step is: what the creep curves allow, up to the next valve edge, change of rail or goal. */

/* Time to a place ahead under the present deceleration, and a little more so that it is reached. */
static double wait_for(const Loop *loop, int s, double ahead)
{
    double speed = loop->now.speed[s], square = speed * speed + 2.0 * loop->present.acceleration[s] * ahead;
    return square > 0.0 ? 2.0 * ahead / (speed + sqrt(square)) + SHORTEST : 1e300;
}

/* Work out the constants of the kernels of wheelsets and vehicle for the rails that lie below the wheels. */
static void work_out_lanes(Loop *loop)
{
    lane_constants(loop->lp, loop->lane_fixed);
    #if COUPLED
    vehicle_constants(loop->sp, loop->number, loop->lp + FIRST_RAIL * LANES, loop->vehicle_fixed);
    #endif
}

/* Put the wheels on the rail of their place. */
static INLINE void lay_rails(Loop *loop)
{
    int changed = 0;
    for (int l = 0; l < LANES; l++) {
        int s = l % STOPS;
        double place = loop->now.distance[s] - loop->lp[OFFSET * LANES + l];
        long reached = loop->patch[l];
        while (reached < loop->patches && loop->patch_start[reached * STOPS + s] <= place) reached++;
        if (reached == loop->patch[l]) continue;
        const double *rail = loop->patch_rail + ((reached - 1) * STOPS + s) * RAIL;
        for (int k = 0; k < RAIL; k++) loop->lp[(FIRST_RAIL + k) * LANES + l] = rail[k];
        loop->patch[l] = reached;
        changed = 1;
    }
    if (!changed) return;
    work_out_lanes(loop);
    observe(loop);
}

/* Tell whether the table of loads of a stop bends at a point; where it is even, as beyond its end, no step is cut. */
static int bends(const Loop *loop, int s, long point)
{
    for (int l = s; l < LANES; l += STOPS) {
        const double *row = loop->load_factor + l * loop->load_points + point;
        double after = point < loop->load_points - 1 ? row[1] - row[0] : 0.0;
        if (row[0] - row[-1] != after) return 1;
    }
    return 0;
}

/* Shorten a step to the next change of rail or point of the table of loads, where the forces have a kink. */
static double before_change(const Loop *loop, int s, double step)
{
    double reach = step * loop->now.speed[s];
    for (int l = s; l < LANES; l += STOPS) {
        double place = loop->now.distance[s] - loop->lp[OFFSET * LANES + l];
        if (loop->patch[l] < loop->patches) {
            double wait = wait_for(loop, s, loop->patch_start[loop->patch[l] * STOPS + s] - place);
            step = wait < step ? wait : step;
        }
    }
    if (loop->load_factor) {
        double spacing = loop->load_spacing[s], place = loop->now.distance[s];
        long point = (long)(place / spacing + 1e-6) + 1;
        while (point < loop->load_points && !bends(loop, s, point) && (double)point * spacing < place + reach) point++;
        double wait = wait_for(loop, s, (double)point * spacing - place);
        if (point < loop->load_points && wait < step) step = wait;
    }
    return step;
}

/* Lengthen the steps where the creep curves are flat, as they are at a sliding wheel: a step is limited by the steeper
   of the slopes now and where the wheel would be after the step. A wheel on its way to rolling is taken as rolling.
   A wheel that adheres and has settled limits nothing: it takes an exponential step. The train may lose a share of its
   speed in a step. */
static INLINE void lengthen(Loop *loop, const double *limited, double *allowed)
{
    const Settings *set = &loop->set;
    const double *radius = loop->lp + RADIUS * LANES, *load = loop->present.load, *damping = loop->damping;
    double longest = set->longest_step;
    WIDE double speed[LANES], later[LANES], ahead[STOPS], wheel[AXLE_STATES * LANES], slope[LANES], further[LANES];
    EACH_STOP {
        double moved = FMA(longest, loop->present.acceleration[s], loop->now.speed[s]);
        ahead[s] = moved > set->regularization_speed ? moved : set->regularization_speed;
    }
    spread(loop->now.speed, speed);
    spread(ahead, later);
    slope_kernel(loop->lane_fixed, speed, loop->now.wheel, load, loop->contact, damping, slope);
    #if COUPLED
    (void)limited;
    #else
    settle(loop, limited, speed, slope, loop->settling);
    #endif
    memcpy(wheel, loop->now.wheel, sizeof wheel);
    EACH_LANE {
        double rolling = later[l] / radius[l], side = speed[l] > radius[l] * wheel[l] ? 1.0 : -1.0;
        double steep = fabs(slope[l]), step = longest * steep > set->slope_limit ? set->slope_limit / steep : longest;
        double moved = FMA(step, loop->present.wheel[l], wheel[l]);
        moved = side * (rolling - moved) > 0.0 ? moved : rolling;
        wheel[l] = loop->settling[l] != 0.0 ? wheel[l] * (later[l] / speed[l]) : moved; /* at the same slip */
    }
    slope_kernel(loop->lane_fixed, later, wheel, load, loop->contact, damping, further);
    EACH_LANE {
        double steep = fabs(slope[l]), next = fabs(further[l]);
        loop->settling[l] = fabs(next - steep) < STEADY * steep ? loop->settling[l] : 0.0;
        steep = next > steep ? next : steep;
        steep = loop->locked[l] != 0.0 || loop->held[l] != 0.0 || loop->settling[l] != 0.0 ? 0.0 : steep;
        slope[l] = longest * steep > set->slope_limit ? set->slope_limit / steep : longest;
    }
    EACH_STOP {
        double braking = fabs(loop->present.acceleration[s]), slow = loop->now.speed[s];
        double least = longest * braking > SPEED_SHARE * set->slope_limit * slow
            ? SPEED_SHARE * set->slope_limit * slow / braking : longest;
        least = slope[s] < least ? slope[s] : least;
        for (int a = 1; a < AXLES; a++) least = slope[a * STOPS + s] < least ? slope[a * STOPS + s] : least;
        allowed[s] = least > allowed[s] ? least : allowed[s];
    }
}

/* Step of every stop: what the slope of the creep curve allows, in equal parts up to the next valve edge or goal. */
static INLINE void choose_steps(Loop *loop, double *next)
{
    const Settings *set = &loop->set;
    double per_speed = set->slope_limit / set->creep_rate, bound = 0.0;
    WIDE double until[STOPS], allowed[STOPS], span[STOPS], limited[STOPS];
    EACH_STOP {
        double after = loop->time[s] + SHORTEST, before = loop->goal[s] - SHORTEST, nearest = loop->goal[s];
        for (int a = 0; a < AXLES; a++) {
            double filled = loop->fill_end[a * STOPS + s], vented = loop->vent_end[a * STOPS + s];
            double edge = filled > after ? filled : 1e300, other = vented > after ? vented : 1e300;
            edge = edge < other ? edge : other;
            #if KINKS
            for (int k = 0; k < KINKS; k++) {
                double kink = loop->kink[k * 2 * LANES + a * STOPS + s];
                kink = kink > after ? kink : 1e300;
                edge = kink < edge ? kink : edge;
            }
            #endif
            edge = edge < before ? edge : 1e300;
            nearest = edge < nearest ? edge : nearest;
        }
        until[s] = nearest;
    }
    EACH_STOP {
        double slow = loop->now.speed[s];
        slow = slow > set->regularization_speed ? slow : set->regularization_speed;
        allowed[s] = slow * per_speed; /* on the steepest rail, rolling */
        span[s] = until[s] - loop->time[s];
    }
    for (int s = 0; s < STOPS; s++) {
        double most = span[s] < set->longest_step ? span[s] : set->longest_step;
        limited[s] = allowed[s] < most && loop->active[s] != 0.0 ? 1.0 : 0.0;
        bound = limited[s] > bound ? limited[s] : bound;
    }
    EACH_LANE loop->settling[l] = 0.0;
    if (bound != 0.0) lengthen(loop, limited, allowed);
    EACH_STOP {
        double wanted = allowed[s] < set->longest_step ? allowed[s] : set->longest_step;
        double count = ceil(span[s] / wanted * (1.0 - 1e-12));
        loop->step[s] = count > 1.0 ? span[s] / count : span[s];
    }
    for (int s = 0; s < STOPS; s++)
        if (loop->active[s] != 0.0 && (loop->patches > 0 || loop->load_factor))
            loop->step[s] = before_change(loop, s, loop->step[s]);
    EACH_STOP {
        double reached = loop->time[s] + loop->step[s];
        int last = reached > until[s] - 1e-12;
        double h = last ? until[s] - loop->time[s] : loop->step[s];
        next[s] = last ? until[s] : reached;
        loop->step[s] = loop->active[s] != 0.0 ? h : 0.0;
    }
}

/* Times of middle and end of the step, and pressure, torque, damping and level of the electrodynamic brake there. */
static INLINE void follow_valves(const Loop *loop, const double *next, double *time, double *pressure, double *torque,
                                 double *filled, double *damping, double *level)
{
    WIDE double when[2 * LANES];
    EACH_STOP {
        time[s] = loop->time[s] + 0.5 * loop->step[s];
        time[STOPS + s] = next[s];
    }
    for (int a = 0; a < AXLES; a++)
        EACH_STOP {
            when[a * STOPS + s] = time[s];
            when[LANES + a * STOPS + s] = time[STOPS + s];
        }
    actuator_kernel(loop->window_fixed, when, pressure, torque, filled, damping, level);
}
