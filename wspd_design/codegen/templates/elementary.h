/* exp, log and atan without branches or tables, so that they vectorize and give the same bits on every machine:
   argument reduction and one polynomial, fitted by Chebyshev interpolation in 50 digits (benchmarks/coefficients.py). */
#include <math.h>
#include <stdint.h>
#include <string.h>

static inline double from_bits(uint64_t b) { double d; memcpy(&d, &b, sizeof d); return d; }
static inline uint64_t to_bits(double d) { uint64_t b; memcpy(&b, &d, sizeof b); return b; }

#define LN2_HIGH 0x1.62e42fefa0000p-1
#define LN2_LOW 0x1.cf79abc9e3b39p-40
#define ROUNDER 0x1.8p52 /* adding it rounds to an integer in the low bits */

static inline double wspd_exp(double x)
{
    x = x < -708.0 ? -708.0 : x;
    x = x > 709.0 ? 709.0 : x;
    double shifted = x * 0x1.71547652b82fep0 + ROUNDER;
    double k = shifted - ROUNDER;
    double r = (x - k * LN2_HIGH) - k * LN2_LOW;
    double r2 = r * r, r4 = r2 * r2;
    double low = (0.5 + 0x1.5555555555557p-3 * r) + r2 * (0x1.5555555555556p-5 + 0x1.11111111100bep-7 * r);
    double mid = (0x1.6c16c16c162c3p-10 + 0x1.a01a01abf85abp-13 * r)
        + r2 * (0x1.a01a01a6e1e2ap-16 + 0x1.71de01fdbf9cap-19 * r);
    double high = (0x1.27e4db46cddd1p-22 + 0x1.af4e554377204p-26 * r) + r2 * 0x1.1f7340dbc337ep-29;
    double q = low + r4 * (mid + r4 * high);
    return (1.0 + (r + r2 * q)) * from_bits((to_bits(shifted) + 1023) << 52);
}

static inline double wspd_log(double x) /* of a positive normal number */
{
    const uint64_t half_root = 0x3fe6a09e667f3bcdu; /* sqrt(1/2) */
    uint64_t u = to_bits(x) + (0x3ff0000000000000u - half_root);
    double k = from_bits((u >> 52) | 0x4330000000000000u) - (0x1p52 + 1023.0);
    double m = from_bits((u & 0x000fffffffffffffu) + half_root);
    double f = (m - 1.0) / (m + 1.0);
    double z = f * f;
    double q = 0x1.0c03af318d9a9p-3;
    q = q * z + 0x1.0fbe940847ce7p-3;
    q = q * z + 0x1.3b1c356bd77a5p-3;
    q = q * z + 0x1.745cf9043c834p-3;
    q = q * z + 0x1.c71c720159da5p-3;
    q = q * z + 0x1.2492492476cc5p-2;
    q = q * z + 0x1.9999999999a38p-2;
    q = q * z + 0x1.5555555555555p-1;
    return k * LN2_HIGH + (2.0 * f + (f * z * q + k * LN2_LOW));
}

static inline double wspd_atan(double x)
{
    double t = fabs(x);
    int beyond = t > 0x1.a827999fcef32p-2; /* tan(pi/8) */
    int far = t > 0x1.3504f333f9de6p1;     /* tan(3 pi/8) */
    double numerator = far ? -1.0 : (beyond ? t - 1.0 : t);
    double denominator = far ? t : (beyond ? t + 1.0 : 1.0);
    double base = far ? 0x1.921fb54442d18p0 : (beyond ? 0x1.921fb54442d18p-1 : 0.0);
    double rest = far ? 0x1.1a62633145c07p-54 : (beyond ? 0x1.1a62633145c07p-55 : 0.0);
    double r = numerator / denominator;
    double z = r * r;
    double z2 = z * z, z4 = z2 * z2;
    double low = (-0x1.5555555555554p-2 + 0x1.9999999999566p-3 * z) + z2 * (-0x1.2492492470753p-3 + 0x1.c71c71b563977p-4 * z);
    double mid = (-0x1.745d1480b7722p-4 + 0x1.3b1369d8eda34p-4 * z)
        + z2 * (-0x1.110c3a7ca410ep-4 + 0x1.e16e244e132c0p-5 * z);
    double high = (-0x1.ab66f98503b27p-5 + 0x1.70995e47fd7e7p-5 * z)
        + z2 * (-0x1.1183570d8db87p-5 + 0x1.ef3f706c20c3bp-7 * z);
    double q = low + z4 * (mid + z4 * high);
    double magnitude = base + (r + (r * z * q + rest));
    return x < 0.0 ? -magnitude : magnitude;
}

static inline double wspd_sin(double x) /* of a moderate argument */
{
    double shifted = x * 0x1.45f306dc9c883p-2 + ROUNDER; /* multiples of pi */
    double k = shifted - ROUNDER;
    double r = ((x - k * 0x1.921fb54400000p1) - k * 0x1.0b4611a000000p-33) - k * 0x1.898cc51701b84p-63;
    double z = r * r;
    double q = 0x1.89a19d400e252p-49;
    q = q * z - 0x1.ae512165ca336p-41;
    q = q * z + 0x1.612401122d89fp-33;
    q = q * z - 0x1.ae6455a0f523dp-26;
    q = q * z + 0x1.71de3a54550e7p-19;
    q = q * z - 0x1.a01a01a018a8cp-13;
    q = q * z + 0x1.1111111111107p-7;
    q = q * z - 0x1.5555555555555p-3;
    double result = r + r * z * q;
    return from_bits(to_bits(result) ^ (to_bits(shifted) << 63));
}
