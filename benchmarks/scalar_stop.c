/* One stop of the four-axle locomotive with the printed adaptive fuzzy law, written by hand the usual way: one
   axle after the other, libm, no vectors. Same equations, integrals and order as the compiled loop, and the same steps as
   long as the slope of the creep curve does not limit them: here that is the steepest slope, whatever the wheels do. */
#include <math.h>

#define AXLES 4
#define RULES 5

typedef struct {
    double mass, radius, inertia /* per wheel */, damping, damping_decay, r0, r1, r2;
    double body_mass, bogie_mass, body_height, bogie_height, rod_height, bogie_spacing, wheelbase;
    double body_frequency, bogie_frequency, pitch_damping;
    double max_torque, max_pressure, supply_rate, fill_time, vent_time;
    double shear, semi_rolling, semi_lateral, c11, reference_load;
    double mu0, ratio, decay, kA, kS;
    double slip_reference, kp, ki, layer, weight_rate, bound_rate, weights[RULES], bound, centres[RULES], widths[RULES];
    double torque_unit;
    double speed, sample_time, longest_step, creep_rate, slope_limit, stop_speed, regularization, judging_speed, time_limit;
    double gravity;
} Input;

typedef struct {
    double distance, time, torque, resistance_impulse, damping_impulse, brake_work, sliding_work, resistance_work;
    double damping_work, judged_time, slip, slip_squared, lock_time, slip_max, steps;
} Output;

typedef struct {
    double v, w[AXLES], body, front, rear, body_rate, front_rate, rear_rate;
} State;

typedef struct {
    double distance, torque[AXLES], resistance, damping[AXLES], brake_work[AXLES], sliding_work[AXLES];
    double resistance_work, damping_work[AXLES], judged, slip[AXLES], slip_squared[AXLES];
} Integrals;

typedef struct {
    State rate;
    Integrals integrand;
    double force[AXLES], slip[AXLES];
} Stage;

static void wheel_loads(const Input *in, const State *y, double *load)
{
    double fixed = in->mass * in->gravity / 8.0;
    load[0] = fixed + y->body / 4.0 + y->front / 2.0;
    load[1] = fixed + y->body / 4.0 - y->front / 2.0;
    load[2] = fixed - y->body / 4.0 + y->rear / 2.0;
    load[3] = fixed - y->body / 4.0 - y->rear / 2.0;
}

static double follow(double target, double value, double rate, double frequency, double damping)
{
    double omega = 2.0 * M_PI * frequency;
    return omega * omega * (target - value) - 2.0 * damping * omega * rate;
}

static void rates(const Input *in, const State *y, const int *locked, const double *torque, double damping,
                  Stage *out)
{
    double load[AXLES], judged = y->v > in->judging_speed ? 1.0 : 0.0, sum = 0.0;
    double reference = y->v > in->regularization ? y->v : in->regularization;
    double scale = 0.25 * M_PI * in->c11 * in->semi_lateral * in->semi_rolling * in->shear;
    wheel_loads(in, y, load);
    out->integrand.judged = judged;
    for (int a = 0; a < AXLES; a++) {
        double sliding = y->v - in->radius * y->w[a], slip = sliding / reference;
        double mu = in->mu0 * (in->ratio + (1.0 - in->ratio) * exp(-in->decay * fabs(sliding)));
        double stiffness = scale * pow(load[a] / in->reference_load, 2.0 / 3.0);
        double eps = stiffness * slip / (mu * load[a]), x = in->kA * eps;
        double f = 2.0 * mu * load[a] / M_PI * (x / (1.0 + x * x) + atan(in->kS * eps));
        double passed = locked[a] ? 2.0 * in->radius * f : torque[a], braked = damping * y->w[a];
        sum += f;
        out->force[a] = f;
        out->slip[a] = slip;
        out->rate.w[a] = locked[a] ? 0.0 : (-0.5 * torque[a] - braked + in->radius * f) / in->inertia;
        out->integrand.torque[a] = passed;
        out->integrand.damping[a] = 2.0 * braked;
        out->integrand.brake_work[a] = passed * y->w[a];
        out->integrand.sliding_work[a] = 2.0 * f * sliding;
        out->integrand.damping_work[a] = 2.0 * braked * y->w[a];
        out->integrand.slip[a] = judged * slip;
        out->integrand.slip_squared[a] = judged * slip * slip;
    }
    double resistance = in->r0 + in->r1 * y->v + in->r2 * y->v * y->v;
    double acceleration = (-2.0 * sum - resistance) / in->mass;
    double own = -in->bogie_mass * acceleration;
    double front = 2.0 * (out->force[0] + out->force[1]), rear = 2.0 * (out->force[2] + out->force[3]);
    double body = -in->body_mass * acceleration * (in->body_height - in->rod_height) / in->bogie_spacing;
    double moment = own * in->bogie_height;
    out->integrand.distance = y->v;
    out->integrand.resistance = resistance;
    out->integrand.resistance_work = resistance * y->v;
    out->rate.v = acceleration;
    out->rate.body = y->body_rate;
    out->rate.front = y->front_rate;
    out->rate.rear = y->rear_rate;
    out->rate.body_rate = follow(body, y->body, y->body_rate, in->body_frequency, in->pitch_damping);
    out->rate.front_rate = follow((moment + (front - own) * in->rod_height) / in->wheelbase, y->front, y->front_rate,
                                  in->bogie_frequency, in->pitch_damping);
    out->rate.rear_rate = follow((moment + (rear - own) * in->rod_height) / in->wheelbase, y->rear, y->rear_rate,
                                 in->bogie_frequency, in->pitch_damping);
}

static void move(const State *from, const State *rate, double h, State *to)
{
    const double *a = (const double *)from, *b = (const double *)rate;
    double *c = (double *)to;
    for (unsigned k = 0; k < sizeof(State) / sizeof(double); k++) c[k] = a[k] + h * b[k];
}

static double pressure(const Input *in, double time, double start, double from, double fill_end, double vent_end)
{
    double t = time < fill_end ? time : fill_end, r = in->supply_rate, passed = exp((start - t) / in->fill_time);
    double p = in->max_pressure * (1.0 - (exp(-r * t) - passed * exp(-r * start)) / (1.0 - in->fill_time * r))
        + passed * (from - in->max_pressure);
    double vented = (time < vent_end ? time : vent_end) - fill_end;
    return vented > 0.0 ? p * exp(-vented / in->vent_time) : p;
}

static double afsmc(const Input *in, double *memory, double v, double w)
{
    double reference = v > in->regularization ? v : in->regularization;
    double e = in->slip_reference - (v - in->radius * w) / reference, s = in->kp * e + in->ki * memory[0];
    double strength[RULES], nearest = 1e300, total = 0.0, u = 0.0, layer = s / in->layer;
    for (int k = 0; k < RULES; k++) {
        double d = (s - in->centres[k]) / in->widths[k];
        strength[k] = d * d;
        if (strength[k] < nearest) nearest = strength[k];
    }
    for (int k = 0; k < RULES; k++) total += strength[k] = exp(nearest - strength[k]);
    for (int k = 0; k < RULES; k++) u += memory[1 + k] * (strength[k] /= total);
    u += memory[1 + RULES] * (layer > 1.0 ? 1.0 : layer < -1.0 ? -1.0 : layer);
    memory[0] += in->sample_time * e;
    for (int k = 0; k < RULES; k++) memory[1 + k] += in->sample_time * in->weight_rate * s * strength[k];
    memory[1 + RULES] += in->sample_time * in->bound_rate * fabs(s);
    double duty = in->torque_unit * u / in->max_torque;
    return duty > 1.0 ? 1.0 : duty < 0.0 ? 0.0 : duty;
}

void stop(const Input *in, Output *out)
{
    State y = {.v = in->speed};
    Integrals total = {0};
    double memory[AXLES][2 + RULES] = {{0}}, p[AXLES] = {0}, torque[AXLES] = {0}, lock_time[AXLES] = {0};
    double fill_end[AXLES], vent_end[AXLES], from[AXLES], time = 0.0, slip_max = 0.0;
    int locked[AXLES] = {0}, moving = 1;
    long steps = 0;
    for (int a = 0; a < AXLES; a++) {
        y.w[a] = in->speed / in->radius;
        for (int k = 0; k < RULES; k++) memory[a][1 + k] = in->weights[k];
        memory[a][1 + RULES] = in->bound;
    }
    for (long sample = 0; moving && time <= in->time_limit; sample++) {
        double begin = time, end = (double)(sample + 1) * in->sample_time;
        for (int a = 0; a < AXLES; a++) {
            fill_end[a] = begin + in->sample_time * afsmc(in, memory[a], y.v, y.w[a]);
            vent_end[a] = begin + in->sample_time;
            from[a] = p[a];
        }
        while (time < end && moving) {
            double until = end;
            for (int a = 0; a < AXLES; a++)
                if (fill_end[a] > time + 1e-9 && fill_end[a] < until - 1e-9) until = fill_end[a];
            double slowest = y.v > in->regularization ? y.v : in->regularization;
            double wanted = slowest * in->slope_limit / in->creep_rate, span = until - time;
            if (wanted > in->longest_step) wanted = in->longest_step;
            double count = ceil(span / wanted * (1.0 - 1e-12)), h = count > 1.0 ? span / count : span;
            double next = time + h;
            if (next > until - 1e-12) next = until, h = until - time;
            double middle[AXLES], last[AXLES];
            for (int a = 0; a < AXLES; a++) {
                double unit = in->max_torque / in->max_pressure;
                middle[a] = unit * pressure(in, time + 0.5 * h, begin, from[a], fill_end[a], vent_end[a]);
                p[a] = pressure(in, next, begin, from[a], fill_end[a], vent_end[a]);
                last[a] = unit * p[a];
            }
            double damping[3];
            for (int k = 0; k < 3; k++) damping[k] = in->damping * exp(-in->damping_decay * (time + 0.5 * k * h));
            Stage k1, k2, k3, k4;
            State y2, y3, y4, reached;
            rates(in, &y, locked, torque, damping[0], &k1);
            for (int attempt = 0; attempt < 2; attempt++) {
                move(&y, &k1.rate, 0.5 * h, &y2);
                rates(in, &y2, locked, middle, damping[1], &k2);
                move(&y, &k2.rate, 0.5 * h, &y3);
                rates(in, &y3, locked, middle, damping[1], &k3);
                move(&y, &k3.rate, h, &y4);
                rates(in, &y4, locked, last, damping[2], &k4);
                const double *a = (const double *)&y, *b1 = (const double *)&k1.rate, *b2 = (const double *)&k2.rate;
                const double *b3 = (const double *)&k3.rate, *b4 = (const double *)&k4.rate;
                for (unsigned k = 0; k < sizeof(State) / sizeof(double); k++)
                    ((double *)&reached)[k] = a[k] + h / 6.0 * (b1[k] + 2.0 * (b2[k] + b3[k]) + b4[k]);
                if (reached.v >= in->stop_speed) break;
                h *= (y.v - in->stop_speed) / (y.v - reached.v);
            }
            const double *i1 = (const double *)&k1.integrand, *i2 = (const double *)&k2.integrand;
            const double *i3 = (const double *)&k3.integrand, *i4 = (const double *)&k4.integrand;
            for (unsigned k = 0; k < sizeof(Integrals) / sizeof(double); k++)
                ((double *)&total)[k] += h / 6.0 * (i1[k] + 2.0 * (i2[k] + i3[k]) + i4[k]);
            for (int a = 0; a < AXLES; a++) {
                if (locked[a]) lock_time[a] += h;
                if (reached.v > in->judging_speed && k4.slip[a] > slip_max) slip_max = k4.slip[a];
                if (!locked[a] && reached.w[a] < 0.0) {
                    total.torque[a] += 2.0 * in->inertia * reached.w[a];
                    reached.w[a] = 0.0;
                    locked[a] = 1;
                } else if (locked[a] && last[a] < 2.0 * in->radius * k4.force[a]) {
                    locked[a] = 0;
                }
                torque[a] = last[a];
            }
            y = reached;
            time = next;
            out->time += h;
            steps++;
            if (y.v <= in->stop_speed * (1.0 + 1e-6)) moving = 0;
        }
    }
    out->distance = total.distance;
    out->resistance_impulse = total.resistance;
    out->resistance_work = total.resistance_work;
    out->judged_time = total.judged;
    for (int a = 0; a < AXLES; a++) {
        out->torque += total.torque[a];
        out->damping_impulse += total.damping[a];
        out->brake_work += total.brake_work[a];
        out->sliding_work += total.sliding_work[a];
        out->damping_work += total.damping_work[a];
        out->slip += total.slip[a] / AXLES;
        out->slip_squared += total.slip_squared[a] / AXLES;
        if (lock_time[a] > out->lock_time) out->lock_time = lock_time[a];
    }
    out->slip_max = slip_max;
    out->steps = (double)steps;
}
