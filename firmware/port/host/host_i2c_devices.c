// What is connected to each simulated I2C bus: a memory like a 24C32 at &H50, a thermometer like an
// LM75 at &H48 (and at &H148 with ten bits), and at &H4F a broken device that holds the clock.
// Context: main.
#include "hal/hal_i2c.h"
#include "host_clock.h"
#include "host_i2c.h"

// ---- Memory -------------------------------------------------------------------------------------

#define MEMORY_SIZE 4096u
#define PAGE_SIZE 32u           // a write goes on at the start of its page
#define WRITE_CYCLE_NS 5000000u // in which it does not answer
#define MEMORY_ADDRESS_BYTES 2u

static struct {
    uint8_t bytes[MEMORY_SIZE];
    uint16_t place;
    bool written; // in this transfer
    uint64_t ready_ns;
} memories[HAL_I2C_PORTS];

static bool memory_acknowledges(unsigned port) {
    return host_clock_now_ns() >= memories[port].ready_ns;
}

static bool memory_take(unsigned port, unsigned index, uint8_t byte) {
    uint16_t *place = &memories[port].place;
    if (index < MEMORY_ADDRESS_BYTES) {
        *place = (uint16_t)(((unsigned)*place << 8 | byte) % MEMORY_SIZE);
        return true;
    }
    memories[port].bytes[*place] = byte;
    memories[port].written = true;
    *place = (uint16_t)(*place / PAGE_SIZE * PAGE_SIZE + (*place + 1) % PAGE_SIZE);
    return true;
}

static uint8_t memory_give(unsigned port) {
    uint8_t byte = memories[port].bytes[memories[port].place];
    memories[port].place = (uint16_t)((memories[port].place + 1) % MEMORY_SIZE);
    return byte;
}

static void memory_stop(unsigned port, uint64_t now_ns) {
    if (memories[port].written) {
        memories[port].written = false;
        memories[port].ready_ns = now_ns + WRITE_CYCLE_NS;
    }
}

// ---- Thermometer --------------------------------------------------------------------------------

#define REGISTERS 4u        // temperature, which cannot be written, configuration, two limits
#define TEMPERATURE 0x1980u // 25.5 degrees, in 1/256

static struct {
    uint8_t bytes[REGISTERS][2];
    uint8_t selected;
    uint8_t next; // byte of the register
} thermometers[HAL_I2C_PORTS];

static bool thermometer_take(unsigned port, unsigned index, uint8_t byte) {
    if (index == 0) {
        thermometers[port].selected = byte % REGISTERS;
        thermometers[port].next = 0;
    } else if (index <= 2) {
        thermometers[port].bytes[thermometers[port].selected][index - 1] = byte;
    }
    return index <= 2;
}

static uint8_t thermometer_give(unsigned port) {
    unsigned place = thermometers[port].next++ % 2;
    if (thermometers[port].selected == 0) {
        return place == 0 ? TEMPERATURE >> 8 : TEMPERATURE & 0xFF;
    }
    return thermometers[port].bytes[thermometers[port].selected][place];
}

static void thermometer_stop(unsigned port, uint64_t now_ns) {
    (void)now_ns;
    thermometers[port].next = 0;
}

// ---- All ----------------------------------------------------------------------------------------

static const host_i2c_device_t devices[] = {
    {.address = 0x50,
     .acknowledges = memory_acknowledges,
     .take = memory_take,
     .give = memory_give,
     .stop = memory_stop},
    {.address = 0x48, .take = thermometer_take, .give = thermometer_give, .stop = thermometer_stop},
    {.address = 0x148,
     .ten_bits = true,
     .take = thermometer_take,
     .give = thermometer_give,
     .stop = thermometer_stop},
    {.address = 0x4F, .never_ends = true},
};

const host_i2c_device_t *host_i2c_device(uint16_t address, bool ten_bits) {
    for (unsigned i = 0; i < sizeof devices / sizeof devices[0]; i++) {
        if (devices[i].address == address && devices[i].ten_bits == ten_bits) {
            return &devices[i];
        }
    }
    return NULL;
}
