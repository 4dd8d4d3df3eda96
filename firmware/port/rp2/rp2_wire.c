// Serial wires to driver chips: a state machine of PIO 0 carries out an exchange by itself
// (tmc_uart.pio), main fills its FIFO before and empties it behind. The direction and level that a
// state machine has given to a pin stay, so it can serve several wires in turn. Context: main.
#include "hal/hal_wire.h"

#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/gpio.h"
#include "hardware/pio.h"

#include "tmc_uart.pio.h"

#define PIO pio0
#define MACHINE 0u // exchanges
#define SETTER 1u  // never runs, only sets pins
#define CYCLES_A_BIT 16u
#define REPLY_BITS_A_BYTE (HAL_WIRE_BYTE_BITS - 1) // the start bit is not taken
#define STOP_BIT (1u << 8)
#define WORDS_MAX 4u // of a FIFO

static_assert(16u + HAL_WIRE_BYTE_BITS * HAL_WIRE_SEND_MAX <= 32u * WORDS_MAX,
              "a frame fits the FIFO");
static_assert(REPLY_BITS_A_BYTE * HAL_WIRE_REPLY_MAX <= 32u * WORDS_MAX, "so does a reply");

// The exchange under way.
static struct {
    uint64_t asked_us;   // the line has to be idle by HELD_BITS behind this
    uint64_t give_up_us; // there will be no reply any more
    uint64_t ready_us;   // it may be over
    uint32_t baud;
    uint8_t tx_gpio;
    uint8_t send_size, reply_size;
    bool under_way;
} exchange;

static uint32_t bits_us(uint32_t bits) {
    return (bits * 1000000u + exchange.baud - 1) / exchange.baud;
}

// ---- Pins ---------------------------------------------------------------------------------------

static void set_direction(unsigned gpio, bool drives) {
    pio_sm_set_pindirs_with_mask(PIO, SETTER, drives ? pins_mask(gpio) : 0, pins_mask(gpio));
}

// The output is high and drives before the pin gets it; until then the pull-up holds the line.
void hal_wire_open(const hal_wire_t *wire) {
    for (unsigned i = 0; i < tmc_uart_program.length; i++) {
        PIO->instr_mem[i] = tmc_uart_program_instructions[i];
    }
    hal_pin_input(wire->rx_gpio, HAL_PULL_UP);
    hal_pin_input(wire->tx_gpio, HAL_PULL_UP);
    pio_sm_set_pins_with_mask(PIO, SETTER, pins_mask(wire->tx_gpio), pins_mask(wire->tx_gpio));
    set_direction(wire->tx_gpio, true);
    gpio_set_function(wire->tx_gpio, GPIO_FUNC_PIO0);
}

void hal_wire_close(const hal_wire_t *wire) {
    if (exchange.tx_gpio == wire->tx_gpio) {
        hal_wire_abort();
    }
    hal_pin_release(wire->tx_gpio);
    hal_pin_release(wire->rx_gpio);
    set_direction(wire->tx_gpio, false);
}

// ---- An exchange --------------------------------------------------------------------------------

// The output is high again behind a frame that was cut off.
void hal_wire_abort(void) {
    if (exchange.under_way) {
        exchange.under_way = false;
        pio_sm_set_enabled(PIO, MACHINE, false);
        set_direction(exchange.tx_gpio, false);
        pio_sm_set_pins_with_mask(PIO, SETTER, pins_mask(exchange.tx_gpio),
                                  pins_mask(exchange.tx_gpio));
    }
}

static void prepare(const hal_wire_t *wire) {
    pio_sm_config config = tmc_uart_program_get_default_config(0);
    sm_config_set_out_pins(&config, wire->tx_gpio, 1);
    sm_config_set_set_pins(&config, wire->tx_gpio, 1);
    sm_config_set_in_pins(&config, wire->rx_gpio);
    sm_config_set_jmp_pin(&config, wire->rx_gpio);
    sm_config_set_out_shift(&config, true, true, 32);
    sm_config_set_in_shift(&config, true, true, 32);
    uint32_t divider_256ths = (SYS_CLK_HZ * (256u / CYCLES_A_BIT) + wire->baud / 2u) / wire->baud;
    sm_config_set_clkdiv_int_frac8(&config, divider_256ths >> 8, (uint8_t)divider_256ths);
    pio_sm_init(PIO, MACHINE, 0, &config);
}

// The numbers and the bits, as the program in tmc_uart.pio wants them.
static void fill(const uint8_t *send, size_t size, size_t reply_size) {
    uint64_t bits = (HAL_WIRE_BYTE_BITS * size - 1) | reply_size << 8;
    unsigned count = 16;
    for (size_t i = 0; i < size; i++) {
        uint64_t frame = (uint64_t)send[i] << 1 | 1u << (HAL_WIRE_BYTE_BITS - 1);
        bits |= frame << count;
        count += HAL_WIRE_BYTE_BITS;
        if (count >= 32) {
            pio_sm_put(PIO, MACHINE, (uint32_t)bits);
            bits >>= 32;
            count -= 32;
        }
    }
    if (count > 0) {
        pio_sm_put(PIO, MACHINE, (uint32_t)bits);
    }
}

// When what is left of the exchange may be over and when it has to be, from now on.
static void set_times(uint64_t now_us, uint32_t idle_bits) {
    uint32_t ready_bits = hal_wire_ready_bits(exchange.send_size, exchange.reply_size);
    uint32_t give_up_bits = hal_wire_give_up_bits(exchange.send_size, exchange.reply_size);
    exchange.ready_us = now_us + bits_us(idle_bits + ready_bits);
    exchange.give_up_us = now_us + bits_us(idle_bits + give_up_bits);
}

void hal_wire_start(const hal_wire_t *wire, const uint8_t *send, size_t size, size_t reply_size) {
    exchange.tx_gpio = wire->tx_gpio;
    exchange.baud = wire->baud;
    exchange.send_size = (uint8_t)size;
    exchange.reply_size = (uint8_t)reply_size;
    exchange.under_way = true;
    prepare(wire);
    fill(send, size, reply_size);
    exchange.asked_us = hal_time_us();
    set_times(exchange.asked_us, reply_size > 0 ? HAL_WIRE_IDLE_BITS : 0);
    pio_sm_set_enabled(PIO, MACHINE, true);
}

// The last word came by `push` and has its bits at the top.
static hal_wire_state_t take_reply(uint8_t *reply) {
    unsigned left = REPLY_BITS_A_BYTE * exchange.reply_size;
    hal_wire_state_t state = HAL_WIRE_DONE;
    uint64_t bits = 0;
    unsigned count = 0;
    for (size_t i = 0; i < exchange.reply_size; i++) {
        if (count < REPLY_BITS_A_BYTE) {
            unsigned of_word = left < 32 ? left : 32;
            bits |= (uint64_t)(pio_sm_get(PIO, MACHINE) >> (32 - of_word)) << count;
            count += of_word;
            left -= of_word;
        }
        reply[i] = (uint8_t)bits;
        state = (bits & STOP_BIT) != 0 ? state : HAL_WIRE_GARBLED;
        bits >>= REPLY_BITS_A_BYTE;
        count -= REPLY_BITS_A_BYTE;
    }
    return state;
}

// The time is looked at before the machine: what it says is at least as new.
hal_wire_state_t hal_wire_poll(uint8_t *reply, uint64_t *again_us) {
    uint64_t now_us = hal_time_us();
    unsigned place = pio_sm_get_pc(PIO, MACHINE);
    bool listens = place >= tmc_uart_offset_listen && place < tmc_uart_offset_take;
    hal_wire_state_t state = HAL_WIRE_BUSY;
    if (!exchange.under_way) {
        return HAL_WIRE_DONE;
    }
    if (place == tmc_uart_offset_done) {
        exchange.under_way = false;
        pio_sm_set_enabled(PIO, MACHINE, false);
        return take_reply(reply);
    }
    if (listens) {
        set_times(now_us, HAL_WIRE_IDLE_BITS);
        state =
            now_us >= exchange.asked_us + bits_us(HAL_WIRE_HELD_BITS) ? HAL_WIRE_HELD_LOW : state;
    } else if (now_us >= exchange.give_up_us) {
        state = HAL_WIRE_SILENT;
    }
    if (state != HAL_WIRE_BUSY) {
        hal_wire_abort();
    }
    uint64_t soon_us = now_us + bits_us(HAL_WIRE_REPLY_EARLIEST_BITS);
    *again_us = exchange.ready_us > soon_us ? exchange.ready_us : soon_us;
    return state;
}
