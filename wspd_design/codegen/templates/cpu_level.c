/* The level of the x86-64 instruction set that processor and operating system offer: 1, 3 or 4. */
#include <cpuid.h>

#define HAS(word, bits) (((word) & (bits)) == (bits))

int wspd_cpu_level(void)
{
    unsigned a, b, c, d, b7 = 0, c7, d7, extended = 0, saved, high;
    if (!__get_cpuid(1, &a, &b, &c, &d)) return 1;
    if (!HAS(c, bit_FMA | bit_MOVBE | bit_OSXSAVE | bit_AVX | bit_F16C)) return 1;
    __asm__("xgetbv" : "=a"(saved), "=d"(high) : "c"(0)); /* registers that the operating system saves */
    if (!__get_cpuid_count(7, 0, &a, &b7, &c7, &d7) || !HAS(saved, 0x6)) return 1;
    if (!__get_cpuid(0x80000001, &a, &b, &extended, &d)) return 1;
    if (!HAS(b7, bit_AVX2 | bit_BMI | bit_BMI2) || !HAS(extended, bit_LZCNT)) return 1;
    return HAS(b7, bit_AVX512F | bit_AVX512BW | bit_AVX512CD | bit_AVX512DQ | bit_AVX512VL) && HAS(saved, 0xe6) ? 4 : 3;
}
