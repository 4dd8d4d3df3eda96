// The hook that arms drivers for homing: which axes it has been asked to arm, and which of them it
// still has to disarm although their cycle has ended. Context: main loop.
#include "stepper/homing_hook.h"

static struct {
    const stepper_homing_hook_t *hook;
    uint8_t asked; // axes that it has been asked to arm
    bool armed;    // and it has done so
    uint8_t left;  // axes of cycles that have ended; to be disarmed
} hooked;

void stepper_homing_set_hook(const stepper_homing_hook_t *hook) {
    hooked.hook = hook;
}

bool stepper_homing_disarms(void) {
    return hooked.left != 0;
}

err_t homing_hook_check(uint32_t axes) {
    return hooked.hook == NULL ? ERR_OK : hooked.hook->check(axes);
}

static stepper_arm_t ask(uint32_t axes, bool on) {
    return hooked.hook == NULL ? STEPPER_ARM_DONE : hooked.hook->arm(axes, on);
}

// What could not be armed has to be disarmed all the same; what could not be disarmed has been told
// and is not tried again.
stepper_arm_t homing_hook_arm(uint32_t axes, bool on) {
    if (on ? hooked.armed : hooked.asked == 0) {
        return STEPPER_ARM_DONE;
    }
    hooked.asked = on ? (uint8_t)axes : hooked.asked;
    stepper_arm_t answer = ask(hooked.asked, on);
    if (answer != STEPPER_ARM_BUSY) {
        hooked.armed = on && answer == STEPPER_ARM_DONE;
        hooked.asked = on ? hooked.asked : 0;
    }
    return answer;
}

void homing_hook_end(void) {
    hooked.left |= hooked.asked;
    hooked.asked = 0;
    hooked.armed = false;
}

stepper_arm_t homing_hook_tidy(void) {
    if (hooked.left == 0) {
        return STEPPER_ARM_DONE;
    }
    stepper_arm_t answer = ask(hooked.left, false);
    hooked.left = answer == STEPPER_ARM_BUSY ? hooked.left : 0;
    return answer;
}
