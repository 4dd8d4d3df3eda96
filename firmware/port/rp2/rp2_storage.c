// The user's data: the last part of the flash chip. The image is linked so that it ends below
// (rp2_storage.ld). Context: main.
#include "hal/hal.h"

#include <string.h>

#include "hardware/flash.h"
#include "hardware/sync.h"

#include "rp2_port.h"

#define STORAGE_START (PICO_FLASH_SIZE_BYTES - HAL_STORAGE_SIZE) // from the start of the chip
static_assert(HAL_STORAGE_SECTOR == FLASH_SECTOR_SIZE, "sector");
static_assert(HAL_STORAGE_PAGE == FLASH_PAGE_SIZE, "page");

void hal_storage_read(uint32_t offset, void *bytes, size_t size) {
    memcpy(bytes, (const uint8_t *)XIP_BASE + STORAGE_START + offset, size);
}

const void *hal_storage_map(uint32_t offset) {
    return (const uint8_t *)XIP_BASE + STORAGE_START + offset;
}

bool hal_storage_is_writable(void) {
    bool writable = hal_on_storage_begin();
    if (writable) {
        hal_on_storage_end();
    }
    return writable;
}

// While the chip is written nothing may run from it, not even an interrupt: they all wait. A tick
// could not, so the core stops it or refuses.
bool hal_storage_erase(uint32_t offset) {
    if (offset % HAL_STORAGE_SECTOR != 0 || offset >= HAL_STORAGE_SIZE || !hal_on_storage_begin()) {
        return false;
    }
    rp2_fault_feed();
    uint32_t interrupts = save_and_disable_interrupts();
    flash_range_erase(STORAGE_START + offset, HAL_STORAGE_SECTOR);
    restore_interrupts(interrupts);
    hal_on_storage_end();
    return true;
}

bool hal_storage_program(uint32_t offset, const void *page) {
    if (offset % HAL_STORAGE_PAGE != 0 || offset >= HAL_STORAGE_SIZE || !hal_on_storage_begin()) {
        return false;
    }
    rp2_fault_feed();
    uint32_t interrupts = save_and_disable_interrupts();
    flash_range_program(STORAGE_START + offset, page, HAL_STORAGE_PAGE);
    restore_interrupts(interrupts);
    hal_on_storage_end();
    return true;
}
