// Writes the report on the simulated machine. Context: any.
#include "host_report.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "hal/hal.h"
#include "host_clock.h"
#include "host_machine.h"
#include "host_system.h"
#include "simulate_tmc_wire.h"

static struct {
    FILE *file;
    const char *path;
} report;

static unsigned number_of(const simulate_tmc_t *tmc) {
    unsigned number = 0;
    while (simulate_tmc_at(number) != tmc) {
        number++;
    }
    return number;
}

static double now_ms(void) {
    return (double)host_clock_now_ns() / 1e6;
}

static void tell_access(const simulate_tmc_access_t *access) {
    const char *name = simulate_tmc_name(access->tmc, access->address);
    fprintf(report.file,
            "{\"ms\": %.6f, \"driver\": %u, \"do\": \"%s\", \"register\": \"%s\", "
            "\"address\": %u, \"value\": %" PRIu32 "}\n",
            (double)access->time_ns / 1e6, number_of(access->tmc),
            access->is_write ? "write" : "read", name != NULL ? name : "", access->address,
            access->value);
}

static void tell_diag(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    const simulate_tmc_t *tmc;
    for (unsigned i = 0; report.file != NULL && (tmc = simulate_tmc_at(i)) != NULL; i++) {
        if ((changed & pins_mask(tmc->diag_gpio)) != 0) {
            fprintf(report.file,
                    "{\"ms\": %.6f, \"driver\": %u, \"do\": \"diag\", \"value\": %u}\n",
                    (double)time_ns / 1e6, i, (levels & pins_mask(tmc->diag_gpio)) != 0);
        }
    }
}

void host_report_open(const char *path) {
    report.path = path;
    report.file = fopen(path, "we");
    if (report.file == NULL) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    simulate_tmc_wire_watch(tell_access);
    if (!simulate_observe(tell_diag, NULL)) {
        host_system_fail("%s: too many parts are simulated", path);
    }
}

// ---- The last line ------------------------------------------------------------------------------

static void tell_axes(void) {
    const char *name;
    const simulate_axis_t *axis;
    for (unsigned i = 0; (axis = host_machine_axis(i, &name)) != NULL; i++) {
        fprintf(report.file,
                "%s{\"name\": \"%s\", \"position\": %" PRId64 ", \"pulses\": %" PRIu64 "}",
                i > 0 ? ", " : "", name, axis->position_steps, axis->pulses);
    }
}

static const char *axis_name(const simulate_tmc_t *tmc) {
    const char *name = "";
    const simulate_axis_t *axis;
    for (unsigned i = 0; (axis = host_machine_axis(i, &name)) != NULL; i++) {
        if (axis == tmc->axis) {
            return name;
        }
    }
    return "";
}

static void tell_registers(simulate_tmc_t *tmc) {
    bool first = true;
    for (unsigned address = 0; address < SIMULATE_TMC_REGISTERS; address++) {
        const char *name = simulate_tmc_name(tmc, address);
        if (name != NULL) {
            fprintf(report.file, "%s\"%s\": %" PRIu32, first ? "" : ", ", name,
                    simulate_tmc_register(tmc, address, host_clock_now_ns()));
            first = false;
        }
    }
}

static void tell_driver(simulate_tmc_t *tmc) {
    fprintf(report.file,
            "{\"chip\": %u, \"tx\": %u, \"address\": %u, \"axis\": \"%s\", \"rotor\": %" PRId64
            ", \"pole\": %" PRId64 ", \"slips\": %" PRIu64 ", \"microsteps\": %" PRIu32
            ", \"current_ma\": %" PRIu32 ", \"diag\": %u, \"writes\": %" PRIu32
            ", \"reads\": %" PRIu32 ", \"bad_frames\": %" PRIu32 ", \"registers\": {",
            tmc->chip, tmc->tx_gpio, tmc->address, axis_name(tmc), tmc->motor.rotor,
            tmc->motor.pole, tmc->motor.slips, simulate_tmc_microsteps(tmc),
            simulate_tmc_current_ma(tmc, host_clock_now_ns()), tmc->diag, tmc->writes, tmc->reads,
            tmc->bad_frames);
    tell_registers(tmc);
    fputs("}}", report.file);
}

void host_report_close(void) {
    if (report.file == NULL) {
        return;
    }
    simulate_tmc_t *tmc;
    fprintf(report.file, "{\"ms\": %.6f, \"do\": \"end\", \"axes\": [", now_ms());
    tell_axes();
    fputs("], \"drivers\": [", report.file);
    for (unsigned i = 0; (tmc = simulate_tmc_at(i)) != NULL; i++) {
        fputs(i > 0 ? ", " : "", report.file);
        tell_driver(tmc);
    }
    fputs("]}\n", report.file);
    if (fclose(report.file) != 0) {
        fprintf(stderr, "stepmite: %s: %s\n", report.path, strerror(errno));
    }
    report.file = NULL;
}
