// PWM slices: ownership, and the settings for a frequency. Context: main loop.
#include "hal/slices.h"

#define DIVIDER_MAX 4095u // 255 15/16
#define COUNTS_MAX                                                                                 \
    65535u // of a period; one less than the counter could, so that a level can be all of it
#define COUNTS_MIN 4u // coarser than quarters is no PWM

// A divider up to a 20th above the least possible is taken if it meets the frequency better.
#define DIVIDER_PLAY 20u

static const char *owners[HAL_PWM_SLICES];

err_t slices_claim(unsigned slice, const char *owner) {
    if (owners[slice] != NULL && owners[slice] != owner) {
        return err_raise(ERR_PIN_OTHER_PWM, "PWM slice %u is in use by %s", slice, owners[slice]);
    }
    owners[slice] = owner;
    return ERR_OK;
}

void slices_disclaim(unsigned slice) {
    owners[slice] = NULL;
}

const char *slices_owner(unsigned slice) {
    return owners[slice];
}

// ---- Frequency ----------------------------------------------------------------------------------

double slices_lowest_hz(uint32_t clock_hz) {
    return (double)clock_hz * 16.0 / ((double)DIVIDER_MAX * COUNTS_MAX);
}

double slices_highest_hz(uint32_t clock_hz) {
    return (double)clock_hz / COUNTS_MIN;
}

// How many counts of this divider come nearest to the period, and how far that is from it.
static double error_of(double cycles_16ths, uint32_t divider, uint32_t *counts) {
    *counts = (uint32_t)(cycles_16ths / divider + 0.5);
    double error = cycles_16ths - (double)divider * *counts;
    return error < 0.0 ? -error : error;
}

double slices_divide(uint32_t clock_hz, double frequency_hz, bool phase_correct, hal_pwm_t *pwm) {
    double cycles_16ths = (double)clock_hz * 16.0 / frequency_hz / (phase_correct ? 2.0 : 1.0);
    if (!(cycles_16ths >= 16.0 * COUNTS_MIN && cycles_16ths <= (double)DIVIDER_MAX * COUNTS_MAX)) {
        return 0.0;
    }
    uint32_t least = (uint32_t)(cycles_16ths / COUNTS_MAX);
    least += (double)least * COUNTS_MAX < cycles_16ths; // up: the counts have to fit
    least = least < 16 ? 16 : least;
    uint32_t best = least, best_counts;
    double best_error = error_of(cycles_16ths, least, &best_counts);
    for (uint32_t divider = least + 1;
         divider <= DIVIDER_MAX && divider <= least + least / DIVIDER_PLAY; divider++) {
        uint32_t counts;
        double error = error_of(cycles_16ths, divider, &counts);
        if (error < best_error && counts >= COUNTS_MIN) {
            best = divider;
            best_counts = counts;
            best_error = error;
        }
    }
    pwm->divider_16ths = (uint16_t)best;
    pwm->top = (uint16_t)(best_counts - 1);
    pwm->phase_correct = phase_correct;
    return (double)clock_hz * 16.0 / ((double)best * best_counts) / (phase_correct ? 2.0 : 1.0);
}
