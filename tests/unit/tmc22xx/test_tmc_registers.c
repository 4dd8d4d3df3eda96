// The table of registers against a second list, typed from the datasheets (TMC2209 rev. 1.09, pages
// 23 to 37; TMC2202/TMC2208/TMC2224 rev. 1.13, sections 5.1 to 5.5) and compared with the masks of
// the maker's own C library and of two other libraries; and looking things up.
#include "tmc22xx/tmc22xx_registers.h"

#include <string.h>
#include <unity.h>

#include "base/base.h"

void setUp(void) {}
void tearDown(void) {}

// Registers as in the datasheets' tables: R, W, RW or RC (write 1 to clear); the chips; the value
// after power-up and why; page of the TMC2209's; fields "high:low name", 8 before a field: TMC2208
// only, 9: TMC2209 only, s: signed.
static const struct {
    unsigned address;
    const char *name;
    const char *access;
    const char *chips;
    uint32_t reset;
    unsigned page;
    const char *fields;
} listed[] = {
    // I_scale_analog and multistep_filt begin with 1, internal_Rsense and en_SpreadCycle by OTP: 0.
    {0x00, "GCONF", "RW", "89", 0x101, 23,
     "0:0 I_scale_analog, 1:1 internal_Rsense, 2:2 en_SpreadCycle, 3:3 shaft, 4:4 index_otpw, "
     "5:5 index_step, 6:6 pdn_disable, 7:7 mstep_reg_select, 8:8 multistep_filt, 9:9 test_mode"},
    // The flag of a reset is set by it.
    {0x01, "GSTAT", "RC", "89", 1, 23, "0:0 reset, 1:1 drv_err, 2:2 uv_cp"},
    {0x02, "IFCNT", "R", "89", 0, 23, "7:0 IFCNT"},
    {0x03, "NODECONF", "W", "89", 0, 24, "11:8 SENDDELAY"},
    {0x04, "OTP_PROG", "W", "89", 0, 24, "2:0 OTPBIT, 5:4 OTPBYTE, 15:8 OTPMAGIC"},
    {0x05, "OTP_READ", "R", "89", 0, 24,
     "4:0 OTP_FCLKTRIM, 5:5 otp_OTTRIM, 6:6 otp_internalRsense, 7:7 otp_TBL, 11:8 OTP_PWM_GRAD, "
     "12:12 otp_pwm_autograd, 15:13 OTP_TPWMTHRS, 16:16 otp_PWM_OFS, 17:17 otp_PWM_REG, "
     "18:18 otp_PWM_FREQ, 20:19 OTP_IHOLDDELAY, 22:21 OTP_IHOLD, 23:23 otp_en_SpreadCycle"},
    {0x06, "IOIN", "R", "89", 0, 25,
     "0:0 ENN, 2:2 MS1, 3:3 MS2, 4:4 DIAG, 6:6 PDN_UART, 7:7 STEP, 8 8:8 SEL_A, 9 8:8 SPREAD_EN, "
     "9:9 DIR, 31:24 VERSION"},
    // Both fields by OTP; OTTRIM of an empty memory is 0, the clock is trimmed in each chip.
    {0x07, "FACTORY_CONF", "RW", "89", 0, 25, "4:0 FCLKTRIM, 9:8 OTTRIM"},
    // IRUN 31; IHOLD and IHOLDDELAY by OTP: 16 and 1.
    {0x10, "IHOLD_IRUN", "W", "89", 1u << 16 | 31u << 8 | 16, 28,
     "4:0 IHOLD, 12:8 IRUN, 19:16 IHOLDDELAY"},
    {0x11, "TPOWERDOWN", "W", "89", 20, 28, "7:0 TPOWERDOWN"},
    {0x12, "TSTEP", "R", "89", 0, 28, "19:0 TSTEP"},
    {0x13, "TPWMTHRS", "W", "89", 0, 28, "19:0 TPWMTHRS"},
    {0x14, "TCOOLTHRS", "W", "9", 0, 29, "19:0 TCOOLTHRS"},
    {0x22, "VACTUAL", "W", "89", 0, 28, "s 23:0 VACTUAL"},
    {0x40, "SGTHRS", "W", "9", 0, 29, "7:0 SGTHRS"},
    {0x41, "SG_RESULT", "R", "9", 0, 29, "9:0 SG_RESULT"},
    {0x42, "COOLCONF", "W", "9", 0, 30,
     "3:0 semin, 6:5 seup, 11:8 semax, 14:13 sedn, 15:15 seimin"},
    {0x6A, "MSCNT", "R", "89", 0, 31, "9:0 MSCNT"},
    {0x6B, "MSCURACT", "R", "89", 0, 31, "s 8:0 CUR_B, s 24:16 CUR_A"},
    // Published as a whole: "reset default = 0x10000053".
    {0x6C, "CHOPCONF", "RW", "89", 0x10000053, 33,
     "3:0 TOFF, 6:4 HSTRT, 10:7 HEND, 16:15 TBL, 17:17 vsense, 27:24 MRES, 28:28 intpol, "
     "29:29 dedge, 30:30 diss2g, 31:31 diss2vs"},
    {0x6F, "DRV_STATUS", "R", "89", 0, 37,
     "0:0 otpw, 1:1 ot, 2:2 s2ga, 3:3 s2gb, 4:4 s2vsa, 5:5 s2vsb, 6:6 ola, 7:7 olb, 8:8 t120, "
     "9:9 t143, 10:10 t150, 11:11 t157, 20:16 CS_ACTUAL, 30:30 stealth, 31:31 stst"},
    // Published as a whole: "reset default = 0xC10D0024".
    {0x70, "PWMCONF", "RW", "89", 0xC10D0024, 35,
     "7:0 PWM_OFS, 15:8 PWM_GRAD, 17:16 pwm_freq, 18:18 pwm_autoscale, 19:19 pwm_autograd, "
     "21:20 freewheel, 27:24 PWM_REG, 31:28 PWM_LIM"},
    {0x71, "PWM_SCALE", "R", "89", 0, 32, "7:0 PWM_SCALE_SUM, s 24:16 PWM_SCALE_AUTO"},
    {0x72, "PWM_AUTO", "R", "89", 0, 32, "7:0 PWM_OFS_AUTO, 23:16 PWM_GRAD_AUTO"},
};

static unsigned chips_of(const char *text) {
    return (strchr(text, '8') != NULL ? TMC22XX_2208 : 0u) |
           (strchr(text, '9') != NULL ? TMC22XX_2209 : 0u);
}

static unsigned access_of(const char *text) {
    return (strchr(text, 'R') != NULL ? TMC22XX_READ : 0u) |
           (strchr(text, 'W') != NULL ? TMC22XX_WRITE : 0u) |
           (strchr(text, 'C') != NULL ? TMC22XX_CLEAR : 0u);
}

// Takes a decimal number off the text.
static unsigned number(const char **text) {
    unsigned value = 0;
    while (**text >= '0' && **text <= '9') {
        value = 10 * value + (unsigned)(*(*text)++ - '0');
    }
    return value;
}

// Compares one field with "[8 |9 |s ]high:low name" and moves on to the next.
static void check_field(const tmc22xx_field_t *field, unsigned chips, const char **text) {
    if (**text == 's') {
        TEST_ASSERT_TRUE_MESSAGE(field->is_signed, field->name);
        *text += 2;
    } else {
        TEST_ASSERT_FALSE_MESSAGE(field->is_signed, field->name);
    }
    if ((*text)[1] == ' ') {
        chips = **text == '8' ? TMC22XX_2208 : TMC22XX_2209;
        *text += 2;
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(chips, field->chips, field->name);
    unsigned high = number(text);
    TEST_ASSERT_EQUAL_INT(':', *(*text)++);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(number(text), field->low_bit, field->name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(high - field->low_bit + 1, field->bits, field->name);
    size_t length = strcspn(++*text, ",");
    TEST_ASSERT_EQUAL_size_t(length, strlen(field->name));
    TEST_ASSERT_EQUAL_STRING_LEN(*text, field->name, length);
    *text += length;
    *text += strspn(*text, ", ");
}

static void test_the_table_is_the_datasheets(void) {
    TEST_ASSERT_EQUAL_size_t(COUNT_OF_ARRAY(listed), tmc22xx_register_count);
    for (size_t i = 0; i < COUNT_OF_ARRAY(listed); i++) {
        const tmc22xx_register_t *reg = &tmc22xx_registers[i];
        TEST_ASSERT_EQUAL_STRING(listed[i].name, reg->name);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(listed[i].address, reg->address, reg->name);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(access_of(listed[i].access), reg->access, reg->name);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(chips_of(listed[i].chips), reg->chips, reg->name);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(listed[i].reset, reg->reset, reg->name);
        TEST_ASSERT_TRUE(listed[i].page >= 23 && listed[i].page <= 37);
        const char *text = listed[i].fields;
        for (unsigned j = 0; j < reg->field_count; j++) {
            check_field(&reg->fields[j], reg->chips, &text);
        }
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", text, reg->name);
    }
}

static uint32_t mask_of(const tmc22xx_field_t *field) {
    uint32_t mask = 0;
    for (unsigned bit = field->low_bit; bit < field->low_bit + field->bits; bit++) {
        TEST_ASSERT_LESS_THAN_UINT_MESSAGE(32, bit, field->name);
        mask |= (uint32_t)1 << bit;
    }
    return mask;
}

// No bit belongs to two fields of a chip, and what a register begins with lies in its fields.
static void test_fields_lie_beside_each_other(void) {
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        const tmc22xx_register_t *reg = &tmc22xx_registers[i];
        for (unsigned chip = TMC22XX_2208; chip <= TMC22XX_2209; chip <<= 1) {
            uint32_t used = 0;
            for (unsigned j = 0; j < reg->field_count; j++) {
                if ((reg->fields[j].chips & chip) != 0) {
                    TEST_ASSERT_TRUE_MESSAGE((reg->chips & chip) != 0, reg->fields[j].name);
                    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, used & mask_of(&reg->fields[j]),
                                                    reg->fields[j].name);
                    used |= mask_of(&reg->fields[j]);
                }
            }
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, reg->reset & ~used & (reg->chips & chip ? ~0u : 0),
                                            reg->name);
        }
    }
}

static void test_all_is_named_and_explained_in_short(void) {
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        const tmc22xx_register_t *reg = &tmc22xx_registers[i];
        TEST_ASSERT_TRUE(i == 0 || reg->address > reg[-1].address);
        TEST_ASSERT_TRUE_MESSAGE(strlen(reg->help) > 3 && strlen(reg->help) < 70, reg->name);
        TEST_ASSERT_TRUE(reg->field_count > 0);
        for (unsigned j = 0; j < reg->field_count; j++) {
            const char *help = reg->fields[j].help;
            TEST_ASSERT_TRUE_MESSAGE(strlen(help) > 3 && strlen(help) < 90, help);
            TEST_ASSERT_NULL_MESSAGE(strpbrk(help, "|\n"), help); // it stands in tables
        }
    }
}

// ---- Fields of values ---------------------------------------------------------------------------

static const tmc22xx_field_t *field_of(const char *reg, const char *name) {
    const tmc22xx_register_t *found = tmc22xx_register(reg, strlen(reg));
    TEST_ASSERT_NOT_NULL(found);
    for (unsigned j = 0; j < found->field_count; j++) {
        if (strcmp(found->fields[j].name, name) == 0) {
            return &found->fields[j];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

static void test_fields_of_values(void) {
    TEST_ASSERT_EQUAL_UINT32(4, tmc22xx_field(0x14030153, field_of("CHOPCONF", "MRES")));
    TEST_ASSERT_EQUAL_UINT32(1, tmc22xx_field(0x14030153, field_of("CHOPCONF", "vsense")));
    TEST_ASSERT_EQUAL_UINT32(0x21, tmc22xx_field(0x21000041, field_of("IOIN", "VERSION")));
    TEST_ASSERT_EQUAL_UINT32(12, tmc22xx_field(0xCF0D0E24, field_of("PWMCONF", "PWM_LIM")));
    TEST_ASSERT_EQUAL_UINT32(0x1FF, tmc22xx_field(0x000001FF, field_of("MSCURACT", "CUR_B")));
    TEST_ASSERT_EQUAL_INT32(-1, tmc22xx_field_signed(0x000001FF, field_of("MSCURACT", "CUR_B")));
    TEST_ASSERT_EQUAL_INT32(-256, tmc22xx_field_signed(0x01000000, field_of("MSCURACT", "CUR_A")));
    TEST_ASSERT_EQUAL_INT32(247, tmc22xx_field_signed(0x00F70000, field_of("MSCURACT", "CUR_A")));
    TEST_ASSERT_EQUAL_INT32(-8388608,
                            tmc22xx_field_signed(0x00800000, field_of("VACTUAL", "VACTUAL")));
    TEST_ASSERT_EQUAL_INT32(255, tmc22xx_field_signed(0xFF, field_of("SGTHRS", "SGTHRS")));
}

// The places that code uses are those of the table.
static void test_constants_are_the_table(void) {
#define REGISTER(which, ...)                                                                       \
    TEST_ASSERT_EQUAL_STRING(#which, tmc22xx_register_at(TMC22XX_REG_##which)->name);
#define FIELD(reg, which, ...)                                                                     \
    TEST_ASSERT_EQUAL_HEX32(mask_of(field_of(#reg, #which)), TMC22XX_MASK(reg, which));            \
    TEST_ASSERT_EQUAL_HEX32(TMC22XX_MASK(reg, which), TMC22XX_BITS(reg, which, 0xFFFFFFFFu));      \
    TEST_ASSERT_EQUAL_HEX32(1, TMC22XX_TAKE(TMC22XX_BITS(reg, which, 1), reg, which));
#define END(reg)
#include "tmc22xx/registers.def"
#undef REGISTER
#undef FIELD
#undef END
}

// ---- Names --------------------------------------------------------------------------------------

static void assert_found(unsigned address, const char *text) {
    const tmc22xx_register_t *found = tmc22xx_register(text, strlen(text));
    TEST_ASSERT_NOT_NULL_MESSAGE(found, text);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(address, found->address, text);
}

static void test_registers_are_found(void) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(listed); i++) {
        unsigned address = listed[i].address;
        char texts[6][16];
        format_text(texts[0], sizeof(texts[0]), "%s", listed[i].name);
        format_text(texts[1], sizeof(texts[1]), "%u", address);
        format_text(texts[2], sizeof(texts[2]), "%03u", address);
        format_text(texts[3], sizeof(texts[3]), "0x%X", address);
        format_text(texts[4], sizeof(texts[4]), "&H%02x", address);
        format_text(texts[5], sizeof(texts[5]), "&h%x", address);
        for (size_t j = 0; j < COUNT_OF_ARRAY(texts); j++) {
            assert_found(address, texts[j]);
        }
    }
    assert_found(0x6C, "chopconf");
    assert_found(0x6F, "Drv_Status");
    assert_found(0x03, "slaveconf");
}

static void test_what_is_no_register_is_not_found(void) {
    static const char *const wrong[] = {
        "",     "GCON",       "GCONFX",      "0x",     "&H",  "0x08",  "8",         "-1",
        "0x6G", "1 ",         " 1",          "0x0x06", "1e2", "0b1",   "128",       "0x80",
        "0xEC", "4294967296", "0x100000000", "65536",  "256", "00000", "&H00000006"};
    for (size_t i = 0; i < COUNT_OF_ARRAY(wrong); i++) {
        TEST_ASSERT_NULL_MESSAGE(tmc22xx_register(wrong[i], strlen(wrong[i])), wrong[i]);
    }
    TEST_ASSERT_NOT_NULL(tmc22xx_register("GCONFIG", 5)); // the length counts
    TEST_ASSERT_NULL(tmc22xx_register("GCONF", 4));
    unsigned found = 0;
    for (unsigned address = 0; address < 70000; address++) {
        found += tmc22xx_register_at(address) != NULL;
    }
    TEST_ASSERT_EQUAL_UINT(COUNT_OF_ARRAY(listed), found);
}

static void test_chips(void) {
    TEST_ASSERT_EQUAL_UINT(TMC22XX_2208, tmc22xx_chip_bit(2208));
    TEST_ASSERT_EQUAL_UINT(TMC22XX_2209, tmc22xx_chip_bit(2209));
    TEST_ASSERT_EQUAL_UINT(0, tmc22xx_chip_bit(2226));
    TEST_ASSERT_EQUAL_UINT(0, tmc22xx_chip_bit(0));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_table_is_the_datasheets);
    RUN_TEST(test_fields_lie_beside_each_other);
    RUN_TEST(test_all_is_named_and_explained_in_short);
    RUN_TEST(test_fields_of_values);
    RUN_TEST(test_constants_are_the_table);
    RUN_TEST(test_registers_are_found);
    RUN_TEST(test_what_is_no_register_is_not_found);
    RUN_TEST(test_chips);
    return UNITY_END();
}
