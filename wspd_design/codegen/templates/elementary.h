/* exp, log, atan2, sin and cos without branches or tables, so that they vectorize and give the same bits on every machine:
   argument reduction and one polynomial, fitted by Chebyshev interpolation in 50 digits. Sums of products are
   fused by name: compilers then have no choice, and machines without the instruction get the same bits, slower. */
#include <math.h>
#include <stdint.h>
#include <string.h>

static inline double from_bits(uint64_t b) { double d; memcpy(&d, &b, sizeof d); return d; }
static inline uint64_t to_bits(double d) { uint64_t b; memcpy(&b, &d, sizeof b); return b; }

/* One stop fills half of the widest vectors, and they would only delay what the next stage waits for. */
#if STOPS == 1 && defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=256")
#endif
#define FMA __builtin_fma
#define LN2_HIGH 0x1.62e42fefa0000p-1
#define LN2_LOW 0x1.cf79abc9e3b39p-40
#define ROUNDER 0x1.8p52 /* adding it rounds to an integer in the low bits */

static inline double wspd_exp(double x)
{
    double shifted = FMA(x, 0x1.71547652b82fep0, ROUNDER);
    double k = shifted - ROUNDER;
    double r = FMA(k, -LN2_LOW, FMA(k, -LN2_HIGH, x));
    double r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
    double low = FMA(r2, FMA(0x1.11111111100bep-7, r, 0x1.5555555555556p-5), FMA(0x1.5555555555557p-3, r, 0.5));
    double mid = FMA(r2, FMA(0x1.71de01fdbf9cap-19, r, 0x1.a01a01a6e1e2ap-16),
                     FMA(0x1.a01a01abf85abp-13, r, 0x1.6c16c16c162c3p-10));
    double high = FMA(r2, 0x1.1f7340dbc337ep-29, FMA(0x1.af4e554377204p-26, r, 0x1.27e4db46cddd1p-22));
    double q = FMA(r8, high, FMA(r4, mid, low));
    double result = FMA(r2, q, 1.0 + r) * from_bits((to_bits(shifted) + 1023) << 52);
    result = x < -708.0 ? 0.0 : result;
    return x > 709.0 ? INFINITY : result;
}

static inline double wspd_log(double x)
{
    const uint64_t half_root = 0x3fe6a09e667f3bcdu; /* sqrt(1/2) */
    int tiny = x < 0x1p-1022;
    uint64_t u = to_bits(tiny ? x * 0x1p54 : x) + (0x3ff0000000000000u - half_root);
    double k = from_bits((u >> 52) | 0x4330000000000000u) - (tiny ? 0x1p52 + 1077.0 : 0x1p52 + 1023.0);
    double m = from_bits((u & 0x000fffffffffffffu) + half_root);
    double f = (m - 1.0) / (m + 1.0);
    double z = f * f;
    double q = 0x1.0c03af318d9a9p-3;
    q = FMA(q, z, 0x1.0fbe940847ce7p-3);
    q = FMA(q, z, 0x1.3b1c356bd77a5p-3);
    q = FMA(q, z, 0x1.745cf9043c834p-3);
    q = FMA(q, z, 0x1.c71c720159da5p-3);
    q = FMA(q, z, 0x1.2492492476cc5p-2);
    q = FMA(q, z, 0x1.9999999999a38p-2);
    q = FMA(q, z, 0x1.5555555555555p-1);
    double result = FMA(k, LN2_HIGH, FMA(2.0, f, FMA(f * z, q, k * LN2_LOW)));
    result = x > 0.0 && x < INFINITY ? result : x; /* infinity and NaN are their own logarithms */
    return x <= 0.0 ? (x < 0.0 ? NAN : -INFINITY) : result;
}

static inline double wspd_atan2(double y, double x) /* not both zero */
{
    const uint64_t sign = 0x8000000000000000u;
    double t = fabs(y), u = fabs(x);
    int beyond = t > 0x1.a827999fcef32p-2 * u; /* tan(pi/8) */
    int far = t > 0x1.3504f333f9de6p1 * u;     /* tan(3 pi/8) */
    double numerator = far ? -u : (beyond ? t - u : t);
    double denominator = far ? t : (beyond ? t + u : u);
    double base = far ? 0x1.921fb54442d18p0 : (beyond ? 0x1.921fb54442d18p-1 : 0.0);
    double rest = far ? 0x1.1a62633145c07p-54 : (beyond ? 0x1.1a62633145c07p-55 : 0.0);
    base = x < 0.0 ? base - 0x1.921fb54442d18p1 : base;
    rest = x < 0.0 ? rest - 0x1.1a62633145c07p-53 : rest;
    uint64_t turned = (to_bits(x) ^ to_bits(y)) & sign; /* the angle is odd in both */
    double r = from_bits(to_bits(numerator / denominator) ^ turned);
    base = from_bits(to_bits(base) ^ turned);
    rest = from_bits(to_bits(rest) ^ turned);
    double z = r * r;
    double z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
    double low = FMA(z2, FMA(0x1.c71c71b563977p-4, z, -0x1.2492492470753p-3),
                     FMA(0x1.9999999999566p-3, z, -0x1.5555555555554p-2));
    double mid = FMA(z2, FMA(0x1.e16e244e132c0p-5, z, -0x1.110c3a7ca410ep-4),
                     FMA(0x1.3b1369d8eda34p-4, z, -0x1.745d1480b7722p-4));
    double high = FMA(z2, FMA(0x1.ef3f706c20c3bp-7, z, -0x1.1183570d8db87p-5),
                      FMA(0x1.70995e47fd7e7p-5, z, -0x1.ab66f98503b27p-5));
    double q = FMA(z8, high, FMA(z4, mid, low));
    return (base + r) + FMA(r * z, q, rest);
}

static inline double wspd_sin_near(double r, uint64_t shifted) /* sin(r), or its opposite where shifted is odd */
{
    double z = r * r;
    double q = 0x1.89a19d400e252p-49;
    q = FMA(q, z, -0x1.ae512165ca336p-41);
    q = FMA(q, z, 0x1.612401122d89fp-33);
    q = FMA(q, z, -0x1.ae6455a0f523dp-26);
    q = FMA(q, z, 0x1.71de3a54550e7p-19);
    q = FMA(q, z, -0x1.a01a01a018a8cp-13);
    q = FMA(q, z, 0x1.1111111111107p-7);
    q = FMA(q, z, -0x1.5555555555555p-3);
    double result = FMA(r * z, q, r);
    return from_bits(to_bits(result) ^ (shifted << 63));
}

static inline double wspd_less_turns(double x, double k) /* x less k pi */
{
    return FMA(k, -0x1.898cc51701b84p-63, FMA(k, -0x1.0b4611a000000p-33, FMA(k, -0x1.921fb54400000p1, x)));
}

static inline double wspd_sin(double x) /* of a moderate argument */
{
    double shifted = FMA(x, 0x1.45f306dc9c883p-2, ROUNDER); /* multiples of pi */
    return wspd_sin_near(wspd_less_turns(x, shifted - ROUNDER), to_bits(shifted));
}

static inline double wspd_cos(double x) /* likewise */
{
    double shifted = FMA(x, 0x1.45f306dc9c883p-2, -0.5) + ROUNDER;
    return -wspd_sin_near(wspd_less_turns(x, shifted - ROUNDER + 0.5), to_bits(shifted));
}
