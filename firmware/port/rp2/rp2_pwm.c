// PWM slices. Context: main; starting and stopping also in the governor, which stops a spindle.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/clocks.h"
#include "hardware/pwm.h"

volatile uint16_t rp2_pwm_nowhere;

uint32_t hal_clock_hz(void) {
    return SYS_CLK_HZ;
}

void hal_pwm_set(unsigned slice, const hal_pwm_t *pwm) {
    pwm_slice_hw_t *hw = &pwm_hw->slice[slice];
    uint32_t mode = (pwm->phase_correct ? PWM_CH0_CSR_PH_CORRECT_BITS : 0) |
                    (pwm->inverted[0] ? PWM_CH0_CSR_A_INV_BITS : 0) |
                    (pwm->inverted[1] ? PWM_CH0_CSR_B_INV_BITS : 0);
    hw->div = pwm->divider_16ths;
    hw->top = pwm->top;
    hw->cc = pwm->level[0] | (uint32_t)pwm->level[1] << PWM_CH0_CC_B_LSB;
    hw->csr = (hw->csr & PWM_CH0_CSR_EN_BITS) | mode;
}

void hal_pwm_start(uint32_t slices, const uint16_t counts[HAL_PWM_SLICES]) {
    hw_clear_bits(&pwm_hw->en, slices);
    for (unsigned slice = 0; slice < HAL_PWM_SLICES; slice++) {
        if ((slices >> slice) & 1) {
            pwm_hw->slice[slice].ctr = counts[slice];
        }
    }
    hw_set_bits(&pwm_hw->en, slices);
}

void hal_pwm_stop(unsigned slice) {
    hw_clear_bits(&pwm_hw->en, 1u << slice);
    pwm_hw->slice[slice].ctr = 0;
}
