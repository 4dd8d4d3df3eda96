// Random numbers that depend on the seed only, on every machine.
#ifndef FUZZ_RANDOM_H
#define FUZZ_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

void fuzz_random_seed(uint64_t seed);
uint64_t fuzz_random_bits(void);

// 0 to `limit` - 1.
unsigned fuzz_random_below(unsigned limit);

// `low` to `high`, both included.
int fuzz_random_between(int low, int high);

bool fuzz_random_percent(unsigned percent);

// One element of an array.
#define FUZZ_RANDOM_PICK(array) ((array)[fuzz_random_below((unsigned)COUNT_OF_ARRAY(array))])

#endif
