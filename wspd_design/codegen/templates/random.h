/* Random numbers by their place: Philox 4x64 of ten rounds (Salmon et al., SC11, 2011) makes random words of a seed and a
   counter, so that a number depends neither on what was drawn before nor on what runs beside it. */
static inline void philox(uint64_t seed, const uint64_t counter[4], uint64_t word[4])
{
    uint64_t key = seed, second = 0;
    memcpy(word, counter, 4 * sizeof *word);
    for (int round = 0; round < 10; round++, key += 0x9e3779b97f4a7c15u, second += 0xbb67ae8584caa73bu) {
        unsigned __int128 a = (unsigned __int128)0xd2e7470ee14c6c93u * word[0];
        unsigned __int128 b = (unsigned __int128)0xca5a826395121157u * word[2];
        word[0] = (uint64_t)(b >> 64) ^ word[1] ^ key, word[1] = (uint64_t)b;
        word[2] = (uint64_t)(a >> 64) ^ word[3] ^ second, word[3] = (uint64_t)a;
    }
}

/* A word as a number within (0, 1). */
static inline double uniform(uint64_t word) { return ((double)(word >> 11) + 0.5) * 0x1p-53; }

/* Two words as one number with the normal distribution (Box and Muller). */
static inline double normal(const uint64_t *word)
{
    return __builtin_sqrt(-2.0 * wspd_log(uniform(word[0]))) * wspd_sin(0x1.921fb54442d18p2 * uniform(word[1]));
}
