// SplitMix64 (Steele, Lea, Flood 2014): a counter, well stirred.
#include "fuzz_random.h"

static uint64_t state;

void fuzz_random_seed(uint64_t seed) {
    state = seed;
}

uint64_t fuzz_random_bits(void) {
    state += 0x9E3779B97F4A7C15u;
    uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

unsigned fuzz_random_below(unsigned limit) {
    return (unsigned)(((fuzz_random_bits() >> 32) * limit) >> 32);
}

int fuzz_random_between(int low, int high) {
    return low + (int)fuzz_random_below((unsigned)(high - low) + 1u);
}

bool fuzz_random_percent(unsigned percent) {
    return fuzz_random_below(100) < percent;
}
