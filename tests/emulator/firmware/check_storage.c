// The flash by the boot ROM's own functions. Context: main.
#include <stdio.h>
#include <string.h>

#include "hardware/flash.h"
#include "hardware/sync.h"
#include "hardware/timer.h"
#include "pico/stdlib.h"

#include "check.h"

#define OFFSET (PICO_FLASH_SIZE_BYTES - 1280u * 1024u)

static const volatile uint8_t *flash_at(uint32_t offset) {
    return (const volatile uint8_t *)(XIP_NOCACHE_NOALLOC_BASE + offset);
}

static void erase(void) {
    uint32_t saved = save_and_disable_interrupts();
    flash_range_erase(OFFSET, FLASH_SECTOR_SIZE);
    restore_interrupts(saved);
}

static void program(const uint8_t *page) {
    uint32_t saved = save_and_disable_interrupts();
    flash_range_program(OFFSET, page, FLASH_PAGE_SIZE);
    restore_interrupts(saved);
}

static volatile uint32_t alarms;

static void on_alarm(uint alarm) {
    (void)alarm;
    alarms++;
}

// The planted fault: an interrupt whose code lies in flash, while the flash erases.
static void interrupt_while_busy(void) {
    uint alarm = (uint)hardware_alarm_claim_unused(true);
    hardware_alarm_set_callback(alarm, on_alarm);
    hardware_alarm_set_target(alarm, make_timeout_time_us(5000));
    flash_range_erase(OFFSET, FLASH_SECTOR_SIZE);
}

// 0: erase, program, program again; 1: only show what is there; 2: erase with interrupts on.
void check_storage(int kind) {
    uint8_t page[FLASH_PAGE_SIZE];
    if (kind == 2) {
        interrupt_while_busy();
    }
    if (kind == 0) {
        uint64_t start_us = time_us_64();
        erase();
        printf("erased %02x in %lu us\n", *flash_at(OFFSET),
               (unsigned long)(time_us_64() - start_us));
        memset(page, 0xA5, sizeof page);
        start_us = time_us_64();
        program(page);
        printf("programmed %02x in %lu us\n", *flash_at(OFFSET),
               (unsigned long)(time_us_64() - start_us));
        memset(page, 0x0F, sizeof page);
        program(page);
    }
    uint8_t id[FLASH_UNIQUE_ID_SIZE_BYTES];
    flash_get_unique_id(id);
    printf("holds %02x %02x next %02x id %02x%02x\n", *flash_at(OFFSET), *flash_at(OFFSET + 255),
           *flash_at(OFFSET + 256), id[0], id[7]);
}
