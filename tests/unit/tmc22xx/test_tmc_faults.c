// Faults at every frame of every kind of job. Whatever happens on the wire: a job that says it has
// succeeded has made the driver what the table says, one that failed has left the table alone, a
// fault that a repeat mends fails nothing, and it all ends after few frames.
#include "bench.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "hal/hal.h"
#include "tmc22xx/drivers.h"
#include "tmc22xx/tmc22xx_registers.h"

#define ADDRESS 1
#define MORE_FRAMES 40 // than without faults, at most
#ifndef RANDOM_JOBS
#define RANDOM_JOBS 100000
#endif

static unsigned driver; // which of them a job is for
static line_chip_t *chips[2];
static char where[160];

void setUp(void) {}
void tearDown(void) {}

// ---- Faults -------------------------------------------------------------------------------------

static struct {
    line_fault_t fault;
    size_t first, times;
    size_t last_reset; // frame behind which the chip was reset
    uint32_t late_us;
} plan;

static line_fault_t planned(size_t frame) {
    bool now = frame >= plan.first && frame < plan.first + plan.times;
    if (now && plan.fault == LINE_RESET_BEHIND) {
        plan.last_reset = frame;
    }
    return now ? plan.fault : LINE_GOOD;
}

static bool is_reset(line_fault_t fault) {
    return fault == LINE_RESET || fault == LINE_RESET_BEHIND;
}

// ---- Jobs ---------------------------------------------------------------------------------------

enum { JOB_NEW, JOB_AGAIN, JOB_CURRENT, JOB_RANGE, JOB_WRITE, JOB_READ, JOB_ARM, JOB_DISARM, JOBS };
static const char *const job_names[JOBS] = {"set-up", "set-up again", "current", "range",
                                            "write",  "read",         "arm",     "disarm"};

static err_t begin(unsigned job) {
    static const uint8_t registers[] = {TMC22XX_REG_SG_RESULT, TMC22XX_REG_CHOPCONF,
                                        TMC22XX_REG_IFCNT};
    tmc22xx_settings_t settings = bench_settings(BENCH_WIRE, chips[driver]->address);
    settings.microsteps = job == JOB_NEW ? 16 : 64;
    switch (job) {
    case JOB_NEW:
    case JOB_AGAIN:
        return tmc22xx_set_up(&settings);
    case JOB_CURRENT:
        return tmc22xx_set_current(driver, 500, 50);
    case JOB_RANGE:
        return tmc22xx_set_current(driver, 1200, -1);
    case JOB_WRITE:
        return tmc22xx_begin_write(driver, TMC22XX_REG_TPWMTHRS, 500);
    case JOB_READ:
        return tmc22xx_begin_read(driver, registers, 3);
    default:
        return tmc22xx_begin_arm(1u << driver, job == JOB_ARM);
    }
}

static err_t run(unsigned job) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, begin(job), where);
    line_run();
    return job >= JOB_ARM ? tmc22xx_arm_result() : tmc22xx_result();
}

// A driver that is set up and has more than the usual in its registers; for JOB_NEW none.
static void prepare(unsigned job, uint8_t ifcnt) {
    line_reset();
    line.late_us = plan.late_us;
    driver = 0;
    chips[0] = line_add(BENCH_WIRE, ADDRESS);
    chips[0]->registers[TMC22XX_REG_SG_RESULT] = 0x1F2;
    if (job != JOB_NEW) {
        TEST_ASSERT_EQUAL(ERR_OK, run(JOB_NEW));
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_write(0, TMC22XX_REG_SGTHRS, 60));
        line_run();
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_write(0, TMC22XX_REG_COOLCONF, 0x8205));
        line_run();
        tmc22xx_keep_threshold(0, 345, true);
    }
    if (job == JOB_DISARM) {
        TEST_ASSERT_EQUAL(ERR_OK, run(JOB_ARM));
    }
    chips[driver]->ifcnt = ifcnt;
}

// ---- What must hold -----------------------------------------------------------------------------

static void check_chip_is(const driver_t *entry) {
    for (unsigned i = 0; i < KEPT_COUNT; i++) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(drivers_wanted(entry, i),
                                        chips[driver]->registers[drivers_register(i)], where);
    }
}

static void check_read(void) {
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0x1F2, tmc22xx_value(0), where);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(chips[driver]->registers[TMC22XX_REG_CHOPCONF],
                                    tmc22xx_value(1), where);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(chips[driver]->ifcnt, tmc22xx_value(2), where);
}

static void check_success(unsigned job, const driver_t *before) {
    const driver_t *entry = drivers_get(driver);
    TEST_ASSERT_NOT_NULL_MESSAGE(entry, where);
    if (job == JOB_READ) {
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(before->kept, entry->kept, sizeof entry->kept, where);
        return;
    }
    check_chip_is(entry);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, entry->dirty, where);
    TEST_ASSERT_EQUAL_MESSAGE(job == JOB_ARM, entry->armed, where);
    if (job == JOB_CURRENT || job == JOB_RANGE) {
        TEST_ASSERT_EQUAL_UINT16(job == JOB_CURRENT ? 5000 : 12000, entry->run_dma);
    }
}

static void check_failure(unsigned job, const driver_t *before, err_t err) {
    const driver_t *entry = drivers_get(driver);
    bool says_partly = strstr(err_message(), "partly") != NULL;
    if (job == JOB_NEW) {
        TEST_ASSERT_NULL_MESSAGE(entry, where);
        TEST_ASSERT_FALSE_MESSAGE(line_is_open(BENCH_WIRE), where);
        return;
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(entry, where);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(before->kept, entry->kept, sizeof entry->kept, where);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(before->run_dma, entry->run_dma, where);
    if (job < JOB_ARM && !says_partly && err != ERR_TMC_LOST && !is_reset(plan.fault)) {
        check_chip_is(entry);
    }
    if (says_partly && err != ERR_TMC_LOST) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, entry->dirty, where);
    }
}

// When the wire is well again all can be mended: by a set-up if the driver was reset, otherwise by
// any change.
static void check_mended(unsigned job) {
    line_expect(NULL);
    line.time_us += 100000; // nothing comes late any more
    bool exists = drivers_get(driver) != NULL;
    bool lost = (chips[driver]->registers[TMC22XX_REG_GSTAT] & 1) != 0;
    if (lost && exists) {
        TEST_ASSERT_EQUAL_MESSAGE(ERR_TMC_LOST, run(JOB_CURRENT), where);
    }
    err_t err = run(lost || !exists ? JOB_NEW : JOB_CURRENT);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", err == ERR_OK ? "" : err_message(), where);
    check_chip_is(drivers_get(driver));
    if (job == JOB_DISARM) { // what could not be disarmed is by whatever comes next
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, chips[driver]->registers[TMC22XX_REG_TCOOLTHRS], where);
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, run(JOB_DISARM), where);
    check_chip_is(drivers_get(driver));
}

// ---- Every frame --------------------------------------------------------------------------------

static size_t clean_frames[JOBS];
static size_t most_frames;
static unsigned runs, good;

static void one(unsigned job, uint8_t ifcnt, bool must_succeed) {
    prepare(job, ifcnt);
    driver_t before = {0};
    if (drivers_get(driver) != NULL) {
        before = *drivers_get(driver);
    }
    snprintf(where, sizeof where, "%s: %s, %u times from frame %u on (late %u us, IFCNT %u)",
             job_names[job], line_fault_name(plan.fault), (unsigned)plan.times,
             (unsigned)plan.first, (unsigned)plan.late_us, ifcnt);
    plan.last_reset = SIZE_MAX;
    line_expect(planned);
    err_t err = run(job);
    size_t frames = line.frame_count;
    most_frames = frames > most_frames ? frames : most_frames;
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(clean_frames[job] + MORE_FRAMES, frames, where);
    runs++;
    good += err == ERR_OK;
    if (must_succeed) {
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", err == ERR_OK ? "" : err_message(), where);
    }
    if (err != ERR_OK) {
        check_failure(job, &before, err);
    } else if (plan.last_reset != frames - 1) { // nobody could have noticed
        check_success(job, &before);
        if (job == JOB_READ && !is_reset(plan.fault)) {
            check_read();
        }
    }
    check_mended(job);
}

static void count_clean_frames(void) {
    plan.times = 0;
    for (unsigned job = 0; job < JOBS; job++) {
        clean_frames[job] = 1000;
        one(job, 3, true);
        prepare(job, 3);
        line_expect(NULL);
        run(job);
        clean_frames[job] = line.frame_count;
    }
}

static void sweep(line_fault_t fault, size_t times, uint32_t late_us, uint8_t ifcnt) {
    for (unsigned job = 0; job < JOBS; job++) {
        for (plan.first = 0; plan.first <= clean_frames[job]; plan.first++) {
            plan.fault = fault;
            plan.times = times;
            plan.late_us = late_us;
            bool in_time = fault != LINE_LATE || late_us < 15000; // while the wire is quiet
            bool mends = times <= 2 && !is_reset(fault) && in_time;
            one(job, ifcnt, mends);
        }
    }
}

static void test_every_fault_at_every_frame(void) {
    count_clean_frames();
    for (line_fault_t fault = LINE_LOST; fault < LINE_FAULTS; fault++) {
        for (size_t times = 1; times <= 4; times++) {
            sweep(fault, times, 5000, 3);
        }
        sweep(fault, SIZE_MAX / 2, 5000, 3); // for ever
    }
    printf("%u jobs, %u succeeded, at most %u frames\n", runs, good, (unsigned)most_frames);
    TEST_ASSERT_GREATER_THAN_UINT(runs / 4, good);
    TEST_ASSERT_LESS_THAN_UINT(runs * 9 / 10, good);
}

// At each write of a job IFCNT goes from 255 to 0 once.
static void test_a_count_that_begins_anew(void) {
    count_clean_frames();
    static const line_fault_t faults[] = {LINE_LOST, LINE_NO_REPLY, LINE_RESET, LINE_RESET_BEHIND,
                                          LINE_BAD_CRC};
    for (uint8_t ifcnt = 246; ifcnt != 0; ifcnt++) {
        for (size_t i = 0; i < COUNT_OF_ARRAY(faults); i++) {
            sweep(faults[i], 1, 5000, ifcnt);
        }
    }
}

// Answers that come in the middle of a later exchange; and all of them.
static void test_late_answers(void) {
    count_clean_frames();
    for (uint32_t late_us = 1200; late_us < 80000; late_us += late_us / 16) {
        sweep(LINE_LATE, 1, late_us, 3);
        sweep(LINE_LATE, 2, late_us, 3);
        sweep(LINE_LATE, SIZE_MAX / 2, late_us, 255);
    }
}

// A driver that answers every request with what it should have answered to the one before.
static void test_a_driver_that_is_one_answer_behind(void) {
    count_clean_frames();
    for (unsigned job = 0; job < JOBS; job++) {
        for (unsigned from = 0; from < 4; from++) { // wherever the turn of registers stands
            prepare(job, 3);
            line.behind = true;
            snprintf(where, sizeof where, "%s: one behind", job_names[job]);
            TEST_ASSERT_NOT_EQUAL_MESSAGE(ERR_OK, run(job), where);
            TEST_ASSERT_NOT_EQUAL_MESSAGE(ERR_OK, run(job), where);
        }
    }
}

// ---- At random ----------------------------------------------------------------------------------

static uint64_t random_state = 0x9E3779B97F4A7C15u;

static uint32_t random_below(uint32_t limit) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (uint32_t)(random_state >> 33) % limit;
}

static uint32_t percent; // of the frames that are bad

static line_fault_t at_random(size_t frame) {
    line_fault_t fault = (line_fault_t)(1 + random_below(LINE_FAULTS - 1));
    bool is_rare = is_reset(fault) && random_below(4) != 0;
    if (random_below(100) >= percent || is_rare) {
        return LINE_GOOD;
    }
    line.late_us = 1000 + random_below(14000);
    if (fault == LINE_RESET_BEHIND) {
        plan.last_reset = frame;
    }
    return fault;
}

// Ctrl-C somewhere in the middle of some statements.
static err_t run_or_give_up(unsigned job) {
    if (job >= JOB_ARM || random_below(10) != 0) {
        return run(job);
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, begin(job), where);
    line_run_until(line.time_us + random_below(40000));
    tmc22xx_give_up();
    line_run();
    return tmc22xx_result();
}

static void random_job(unsigned job, unsigned number) {
    driver_t before = *drivers_get(driver);
    snprintf(where, sizeof where, "%u: %s with %u %% of the frames bad", number, job_names[job],
             (unsigned)percent);
    plan.last_reset = SIZE_MAX;
    line_expect(at_random);
    err_t err = run_or_give_up(job);
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(10 * clean_frames[job] + MORE_FRAMES, line.frame_count,
                                           where);
    good += err == ERR_OK;
    if (err != ERR_OK) {
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(before.kept, drivers_get(driver)->kept, sizeof before.kept,
                                         where);
    } else if (job != JOB_READ && plan.last_reset != line.frame_count - 1) {
        check_chip_is(drivers_get(driver));
    }
    if (err == ERR_TMC_LOST || random_below(50) == 0) {
        line_expect(NULL);
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, run(JOB_NEW), where);
        check_chip_is(drivers_get(driver));
    }
}

static void test_at_random(void) {
    count_clean_frames();
    prepare(JOB_CURRENT, 3);
    chips[1] = line_add(BENCH_WIRE, 2); // on the same wire: an answer does not say who it is from
    driver = 1;
    TEST_ASSERT_EQUAL(ERR_OK, run(JOB_NEW));
    good = 0;
    for (unsigned i = 0; i < RANDOM_JOBS; i++) {
        percent = 1 + i / 50 % 40;
        driver = random_below(2);
        random_job(JOB_AGAIN + random_below(JOBS - JOB_AGAIN), i);
    }
    printf("%u jobs at random, %u succeeded\n", RANDOM_JOBS, good);
    TEST_ASSERT_GREATER_THAN_UINT(RANDOM_JOBS / 5, good);
    TEST_ASSERT_LESS_THAN_UINT(RANDOM_JOBS * 9 / 10, good);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_fault_at_every_frame);
    RUN_TEST(test_a_count_that_begins_anew);
    RUN_TEST(test_late_answers);
    RUN_TEST(test_a_driver_that_is_one_answer_behind);
    RUN_TEST(test_at_random);
    return UNITY_END();
}
