// Counters, in state machines of PIO 1: they follow edges a few cycles apart without the processor.
// Each has its result in a register, from which an instruction put in between fetches it. Contexts:
// main, and hal_counter_read() the alarm.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/clocks.h"
#include "hardware/pio.h"

#define PIO pio1
static_assert(HAL_COUNTERS == NUM_PIO_STATE_MACHINES, "a state machine for each counter");

// Where the programs start in the instruction memory.
#define RISING 0u
#define FALLING 3u
#define BOTH 6u
#define PERIOD 10u
#define SIZE 22u

// Each turn of the period's loops takes so many cycles, and between two measurements so many are
// lost.
#define CYCLES_A_TURN 3u
#define CYCLES_BETWEEN 4u

static double period_s[HAL_COUNTERS]; // the last measurement

// X counts down from all ones at each edge; the jumps only make it count, they lead to the next
// line anyway.
static void load_counters(void) {
    const uint16_t low = (uint16_t)pio_encode_wait_pin(false, 0);
    const uint16_t high = (uint16_t)pio_encode_wait_pin(true, 0);
    const uint16_t program[] = {
        low,
        high,
        (uint16_t)pio_encode_jmp_x_dec(RISING),
        high,
        low,
        (uint16_t)pio_encode_jmp_x_dec(FALLING),
        low,
        (uint16_t)pio_encode_jmp_x_dec(BOTH + 2),
        high,
        (uint16_t)pio_encode_jmp_x_dec(BOTH),
    };
    for (unsigned i = 0; i < COUNT_OF_ARRAY(program); i++) {
        PIO->instr_mem[RISING + i] = program[i];
    }
}

// X counts turns of two loops, one for each level, that take the same time; Y counts periods, of
// which there is one less in OSR. At the end X goes to ISR.
static void load_period(void) {
    enum { AGAIN = PERIOD + 2, HIGH = AGAIN + 2, LOW = HIGH + 2, RISEN = LOW + 3 };
    const uint16_t program[] = {
        (uint16_t)pio_encode_wait_pin(false, 0),
        (uint16_t)pio_encode_wait_pin(true, 0),
        (uint16_t)pio_encode_mov(pio_y, pio_osr), // AGAIN
        (uint16_t)pio_encode_mov_not(pio_x, pio_null),
        (uint16_t)pio_encode_jmp_x_dec(HIGH + 1), // HIGH
        (uint16_t)(pio_encode_jmp_pin(HIGH) | pio_encode_delay(1)),
        (uint16_t)pio_encode_jmp_x_dec(LOW + 1), // LOW
        (uint16_t)pio_encode_jmp_pin(RISEN),
        (uint16_t)pio_encode_jmp(LOW),
        (uint16_t)pio_encode_jmp_y_dec(HIGH), // RISEN
        (uint16_t)pio_encode_mov(pio_isr, pio_x),
        (uint16_t)pio_encode_jmp(AGAIN),
    };
    static_assert(PERIOD + COUNT_OF_ARRAY(program) == SIZE,
                  "the programs are one behind the other");
    for (unsigned i = 0; i < COUNT_OF_ARRAY(program); i++) {
        PIO->instr_mem[PERIOD + i] = program[i];
    }
}

// Makes the state machine ready at the first line of a program whose last is before `end`.
static void prepare(unsigned counter, unsigned gpio, unsigned start, unsigned end) {
    load_counters();
    load_period();
    pio_sm_config config = pio_get_default_sm_config();
    sm_config_set_in_pins(&config, gpio);
    sm_config_set_jmp_pin(&config, gpio);
    sm_config_set_wrap(&config, start, end - 1);
    pio_sm_init(PIO, counter, start, &config);
}

// Runs an instruction that leaves a word in the FIFO.
static uint32_t fetch(unsigned counter, unsigned instruction) {
    while (!pio_sm_is_rx_fifo_empty(PIO, counter)) {
        pio_sm_get(PIO, counter);
    }
    pio_sm_exec(PIO, counter, instruction);
    while (pio_sm_is_rx_fifo_empty(PIO, counter)) {
    }
    return pio_sm_get(PIO, counter);
}

void hal_counter_start(unsigned counter, unsigned gpio, hal_edge_t edges) {
    switch (edges) {
    case HAL_EDGE_RISING:
        prepare(counter, gpio, RISING, FALLING);
        break;
    case HAL_EDGE_FALLING:
        prepare(counter, gpio, FALLING, BOTH);
        break;
    case HAL_EDGE_BOTH:
        // It has to start where the pin is: waiting for what is there already would count no edge.
        prepare(counter, gpio, BOTH, PERIOD);
        if ((hal_pins_read() & pins_mask(gpio)) == 0) {
            pio_sm_exec(PIO, counter, pio_encode_jmp(BOTH + 2));
        }
        break;
    }
    pio_sm_exec(PIO, counter, pio_encode_mov_not(pio_x, pio_null));
    pio_sm_set_enabled(PIO, counter, true);
}

uint32_t hal_counter_read(unsigned counter) {
    pio_sm_exec(PIO, counter, pio_encode_mov(pio_isr, pio_x));
    return ~fetch(counter, pio_encode_push(false, false));
}

void hal_period_start(unsigned counter, unsigned gpio, uint32_t periods) {
    period_s[counter] = 0.0;
    prepare(counter, gpio, PERIOD, SIZE);
    pio_sm_put(PIO, counter, periods - 1);
    pio_sm_exec(PIO, counter, pio_encode_pull(false, true));
    pio_sm_set_enabled(PIO, counter, true);
}

// Fetching clears ISR: a word that is not 0 is a new measurement.
double hal_period_read(unsigned counter) {
    uint32_t word = fetch(counter, pio_encode_push(false, false));
    if (word != 0) {
        double cycles = (double)~word * CYCLES_A_TURN + CYCLES_BETWEEN;
        period_s[counter] = cycles / SYS_CLK_HZ;
    }
    return period_s[counter];
}

void hal_counter_stop(unsigned counter) {
    pio_sm_set_enabled(PIO, counter, false);
}
