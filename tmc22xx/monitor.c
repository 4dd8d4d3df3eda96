// A look at one driver after the other, and what is told of it once. Context: main loop.
#include "tmc22xx/monitor.h"

#include "base/base.h"
#include "hal/hal.h"
#include "tmc22xx/outcome.h"
#include "tmc22xx/tmc22xx_registers.h"

#define PERIOD_US 1000000u // each driver is asked so often

// A condition that comes and goes is not told again before it was away for so many looks.
#define CALM_LOOKS 10u

// A driver on a loose wire has to answer for so many looks before that is told.
#define ANSWERED_LOOKS 3u

static struct {
    bool off;
    bool news;    // there may be something to tell
    uint8_t next; // driver
    uint64_t due_us;
} monitor;

#define NAME_SIZE 64

static const struct {
    uint8_t condition;
    const char *text;
} texts[] = {
    {DRIVERS_OVERHEATED, "is overheated and has switched the motor off"},
    {DRIVERS_SHORT, "has found a short circuit at a motor coil and has switched the motor off"},
    {DRIVERS_LOST, "has lost its settings (was its power off?): set it up again"},
    {DRIVERS_UNDERVOLTAGE,
     "has too low a voltage and has switched the motor off: check its supply"},
    {DRIVERS_ERROR, "has had the motor off for a moment: overheated, or a short circuit"},
    {DRIVERS_HOT, "is hot: less current or more cooling, or it will switch the motor off"},
    {DRIVERS_SILENT, "does not answer any more: check its supply and the wire"},
};

// ---- What is known ------------------------------------------------------------------------------

void monitor_note_answer(driver_t *entry) {
    entry->conditions &= (uint8_t)~DRIVERS_SILENT;
    monitor.news = true;
}

void monitor_note_reset(driver_t *entry) {
    entry->conditions |= DRIVERS_LOST;
    monitor.news = true;
}

// A statement that failed has told the user why.
void monitor_note_failure(driver_t *entry, uint8_t fault, bool is_monitor) {
    uint8_t condition = 0;
    if (fault == ACCESS_LOST) {
        condition = DRIVERS_LOST;
    } else if (fault == ACCESS_SILENT || fault == ACCESS_HELD_LOW || fault == ACCESS_GARBLED) {
        condition = DRIVERS_SILENT;
    }
    entry->conditions |= condition;
    entry->answered = 0;
    monitor.news = true;
    if (!is_monitor) {
        entry->told |= condition;
    }
}

static bool has(uint32_t value, uint32_t mask) {
    return (value & mask) != 0;
}

// What was told and is over may be told again: at once what the driver itself keeps until it is
// cleared, the rest when it has been away for a while.
static void forget_told(driver_t *entry) {
    const uint8_t lasting = DRIVERS_ERROR | DRIVERS_LOST;
    entry->told &= (uint8_t)(~lasting | entry->conditions);
    bool calm = (entry->conditions & ~lasting) == 0;
    entry->calm = calm ? (uint8_t)(entry->calm + 1) : 0;
    if (entry->calm == CALM_LOOKS) {
        entry->calm = 0;
        entry->told &= lasting | DRIVERS_SILENT;
    }
}

void monitor_note(driver_t *entry, uint32_t gstat, uint32_t drv_status) {
    uint32_t shorts = TMC22XX_MASK(DRV_STATUS, s2ga) | TMC22XX_MASK(DRV_STATUS, s2gb) |
                      TMC22XX_MASK(DRV_STATUS, s2vsa) | TMC22XX_MASK(DRV_STATUS, s2vsb);
    bool hot = has(drv_status, TMC22XX_MASK(DRV_STATUS, otpw));
    bool overheated = has(drv_status, TMC22XX_MASK(DRV_STATUS, ot));
    bool is_short = has(drv_status, shorts);
    bool undervoltage = has(gstat, TMC22XX_MASK(GSTAT, uv_cp));
    bool error = has(gstat, TMC22XX_MASK(GSTAT, drv_err));
    bool lost = has(gstat, TMC22XX_MASK(GSTAT, reset)) || (entry->conditions & DRIVERS_LOST) != 0;
    entry->conditions =
        (uint8_t)((hot && !overheated ? DRIVERS_HOT : 0) | (overheated ? DRIVERS_OVERHEATED : 0) |
                  (is_short ? DRIVERS_SHORT : 0) | (undervoltage ? DRIVERS_UNDERVOLTAGE : 0) |
                  (error ? DRIVERS_ERROR : 0) | (lost ? DRIVERS_LOST : 0));
    if (overheated || is_short) {
        entry->told |= DRIVERS_ERROR; // with its reason
    }
    entry->answered = (uint8_t)(entry->answered + (entry->answered < ANSWERED_LOOKS));
    forget_told(entry);
    monitor.news = true;
}

// ---- Whose turn it is ---------------------------------------------------------------------------

static bool is_watched(unsigned driver) {
    const driver_t *entry = drivers_get(driver);
    return entry != NULL && entry->listens;
}

static unsigned next_watched(void) {
    for (unsigned i = 1; i <= TMC22XX_DRIVERS; i++) {
        unsigned driver = (monitor.next + i) % TMC22XX_DRIVERS;
        if (is_watched(driver)) {
            return driver;
        }
    }
    return DRIVERS_NONE;
}

bool monitor_is_due(void) {
    return drivers_count() != 0 && !monitor.off && tmc22xx_verifies() &&
           hal_time_us() >= monitor.due_us && next_watched() != DRIVERS_NONE;
}

// After a long sleep of the main loop each driver's turn comes once, not as often as was missed.
unsigned monitor_take_turn(void) {
    if (!monitor_is_due()) {
        return DRIVERS_NONE;
    }
    uint64_t now_us = hal_time_us();
    uint32_t apart_us = PERIOD_US / drivers_count();
    uint32_t most_us = PERIOD_US - apart_us; // behind
    monitor.due_us = now_us - monitor.due_us > most_us ? now_us - most_us : monitor.due_us;
    monitor.due_us += apart_us;
    monitor.next = (uint8_t)next_watched();
    return monitor.next;
}

void tmc22xx_monitor(bool on) {
    monitor.off = !on;
}

bool tmc22xx_monitors(void) {
    return !monitor.off;
}

// ---- What is told -------------------------------------------------------------------------------

static const char *take_news(driver_t *entry) {
    uint8_t news = entry->conditions & (uint8_t)~entry->told;
    for (size_t i = 0; i < COUNT_OF_ARRAY(texts); i++) {
        if ((news & texts[i].condition) != 0) {
            entry->told |= texts[i].condition;
            return texts[i].text;
        }
    }
    bool is_back = (entry->told & (uint8_t)~entry->conditions & DRIVERS_SILENT) != 0;
    if (is_back && entry->answered == ANSWERED_LOOKS) {
        entry->told &= (uint8_t)~DRIVERS_SILENT;
        return "answers again";
    }
    return NULL;
}

bool tmc22xx_next_event(char *text, size_t size) {
    for (unsigned i = 0; monitor.news && i < TMC22XX_DRIVERS; i++) {
        driver_t *entry = drivers_get(i);
        const char *news = entry != NULL ? take_news(entry) : NULL;
        if (news != NULL) {
            char name[NAME_SIZE];
            outcome_name(name, sizeof name, entry);
            format_text(text, size, "%s %s", name, news);
            return true;
        }
    }
    monitor.news = false;
    return false;
}
