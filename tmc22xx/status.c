// The table of conditions, and what is in a value. Context: any.
#include "tmc22xx/status.h"

#include "base/base.h"
#include "tmc22xx/tmc22xx_registers.h"

#define IN(reg, severity, bits, match, text)                                                       \
    {TMC22XX_REG_##reg, (severity), (bits), (match), (text)}
#define BIT(reg, name) TMC22XX_MASK(reg, name)
#define SET(reg, severity, name, text) IN(reg, severity, BIT(reg, name), BIT(reg, name), text)
#define CLEAR(reg, severity, name, text) IN(reg, severity, BIT(reg, name), 0, text)
// One bit is set and another one is not.
#define SET_WITHOUT(reg, severity, name, other, text)                                              \
    IN(reg, severity, BIT(reg, name) | BIT(reg, other), BIT(reg, name), text)

// An open coil is seen by its current, so at standstill the flags mean nothing.
const tmc22xx_condition_t tmc22xx_conditions[] = {
    SET(GSTAT, TMC22XX_FAULT, reset, "it has lost its settings (was its power off?)"),
    SET(GSTAT, TMC22XX_FAULT, uv_cp, "motor off: supply voltage too low (charge pump)"),
    SET(GSTAT, TMC22XX_WARNING, drv_err, "the motor was switched off by heat or a short circuit"),
    SET(IOIN, TMC22XX_STATE, ENN, "motor off by the enable pin"),
    CLEAR(IOIN, TMC22XX_STATE, ENN, "enabled by the enable pin"),
    SET(DRV_STATUS, TMC22XX_FAULT, ot, "motor off: the driver is overheated"),
    SET(DRV_STATUS, TMC22XX_FAULT, s2ga, "motor coil A: short to ground"),
    SET(DRV_STATUS, TMC22XX_FAULT, s2gb, "motor coil B: short to ground"),
    SET(DRV_STATUS, TMC22XX_FAULT, s2vsa, "motor coil A: short to the supply"),
    SET(DRV_STATUS, TMC22XX_FAULT, s2vsb, "motor coil B: short to the supply"),
    SET_WITHOUT(DRV_STATUS, TMC22XX_WARNING, otpw, ot, "the driver is hot (temperature warning)"),
    SET_WITHOUT(DRV_STATUS, TMC22XX_HINT, ola, stst, "motor coil A: seems not connected"),
    SET_WITHOUT(DRV_STATUS, TMC22XX_HINT, olb, stst, "motor coil B: seems not connected"),
    SET(DRV_STATUS, TMC22XX_STATE, stst, "standstill"),
    CLEAR(DRV_STATUS, TMC22XX_STATE, stst, "in motion"),
    SET(DRV_STATUS, TMC22XX_STATE, stealth, "StealthChop"),
    CLEAR(DRV_STATUS, TMC22XX_STATE, stealth, "SpreadCycle"),
};

const size_t tmc22xx_condition_count = COUNT_OF_ARRAY(tmc22xx_conditions);

_Static_assert(COUNT_OF_ARRAY(tmc22xx_conditions) <= TMC22XX_CONDITIONS_MAX, "a bit for each");

uint32_t tmc22xx_conditions_of(uint8_t reg, uint32_t value) {
    uint32_t holding = 0;
    for (size_t i = 0; i < tmc22xx_condition_count; i++) {
        const tmc22xx_condition_t *condition = &tmc22xx_conditions[i];
        if (condition->reg == reg && (value & condition->mask) == condition->match) {
            holding |= (uint32_t)1 << i;
        }
    }
    return holding;
}

unsigned tmc22xx_temperature(uint32_t drv_status) {
    static const struct {
        uint32_t bit;
        uint8_t degrees;
    } thresholds[] = {
        {TMC22XX_MASK(DRV_STATUS, t157), 157},
        {TMC22XX_MASK(DRV_STATUS, t150), 150},
        {TMC22XX_MASK(DRV_STATUS, t143), 143},
        {TMC22XX_MASK(DRV_STATUS, t120), 120},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(thresholds); i++) {
        if ((drv_status & thresholds[i].bit) != 0) {
            return thresholds[i].degrees;
        }
    }
    return 0;
}
