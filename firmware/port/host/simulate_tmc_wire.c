// Datagrams and answers of the simulated drivers. Context: any.
#include "simulate_tmc_wire.h"

#include <string.h>

#include "simulate_tmc_state.h"

#define REQUEST_SIZE 4u
#define DATAGRAM_SIZE 8u
#define SYNC 0x05u
#define MASTER 0xFFu
#define WRITES 0x80u // of the byte with the register
#define BYTE_BITS 10u
#define SILENCE_BITS 12u
#define PAUSE_BITS 63u
#define BAUD_MIN 9000u
#define CLOCKS_A_BIT_MIN 16u
#define LATE_MIN_NS 2000000u
#define LATE_SPREAD_NS 8000000u
#define STOP_BIT 8u // behind the data bits

static struct {
    simulate_tmc_wire_t list[SIMULATE_TMC_MAX];
    unsigned count;
    void (*watcher)(const simulate_tmc_access_t *access);
} wires;

void simulate_tmc_wire_watch(void (*watcher)(const simulate_tmc_access_t *access)) {
    wires.watcher = watcher;
}

// The polynomial x^8 + x^2 + x + 1, the lowest bit of each byte first.
uint8_t simulate_tmc_wire_checksum(const uint8_t *bytes, unsigned size) {
    unsigned sum = 0;
    for (unsigned bit = 0; bit < size * 8; bit++) {
        unsigned in = ((unsigned)bytes[bit / 8] >> (bit % 8) & 1u) ^ (sum >> 7 & 1u);
        sum = (sum << 1 & 0xFFu) ^ (in != 0 ? 0x07u : 0);
    }
    return (uint8_t)sum;
}

static uint32_t next_random(simulate_tmc_wire_t *wire) {
    wire->random ^= wire->random << 13;
    wire->random ^= wire->random >> 17;
    wire->random ^= wire->random << 5;
    return wire->random;
}

// ---- The receiver -------------------------------------------------------------------------------

static unsigned refuse(simulate_tmc_wire_t *wire) {
    wire->error = true;
    wire->count = 0;
    wire->tmc->bad_frames++;
    return 0;
}

// Takes a byte. Returns how many bytes the datagram has that is complete with it, else 0.
static unsigned take_byte(simulate_tmc_wire_t *wire, uint8_t byte, bool stop_bit, uint64_t start_ns,
                          double bit_ns) {
    double silence_ns = start_ns > wire->end_ns ? (double)(start_ns - wire->end_ns) : 0.0;
    double apart_ns = start_ns > wire->start_ns ? (double)(start_ns - wire->start_ns) : 0.0;
    wire->error = wire->error && silence_ns < SILENCE_BITS * bit_ns;
    wire->count = apart_ns > PAUSE_BITS * bit_ns ? 0 : wire->count;
    wire->start_ns = start_ns;
    wire->end_ns = start_ns + (uint64_t)(BYTE_BITS * bit_ns);
    if (wire->error) {
        return 0;
    }
    wire->bytes[wire->count++] = byte;
    if (!stop_bit || (wire->bytes[0] & 0x0F) != SYNC) {
        return refuse(wire);
    }
    bool writes = wire->count > 2 && (wire->bytes[2] & WRITES) != 0;
    unsigned size = writes ? DATAGRAM_SIZE : REQUEST_SIZE;
    if (wire->count < size) {
        return 0;
    }
    wire->count = 0;
    uint8_t checksum = simulate_tmc_wire_checksum(wire->bytes, size - 1);
    return wire->bytes[size - 1] == checksum ? size : refuse(wire);
}

// ---- Answers ------------------------------------------------------------------------------------

static uint32_t send_delay_bits(const simulate_tmc_t *tmc) {
    return 8 * (tmc_bits(tmc->registers[TMC_SLAVECONF], 8, 4) | 1u);
}

// One bit of one byte turns over, a stop bit perhaps.
static void damage(simulate_tmc_wire_t *wire, simulate_wire_words_t *words) {
    unsigned byte = next_random(wire) % (unsigned)words->size;
    unsigned bit = next_random(wire) % (STOP_BIT + 1);
    if (bit == STOP_BIT) {
        words->no_stop_bytes ^= 1u << byte;
    } else {
        words->bytes[byte] ^= (uint8_t)(1u << bit);
    }
}

static void answer_with(simulate_tmc_wire_t *wire, unsigned address, uint32_t value,
                        simulate_wire_words_t *answer) {
    uint8_t bytes[DATAGRAM_SIZE] = {SYNC,
                                    MASTER,
                                    (uint8_t)address,
                                    (uint8_t)(value >> 24),
                                    (uint8_t)(value >> 16),
                                    (uint8_t)(value >> 8),
                                    (uint8_t)value};
    bytes[DATAGRAM_SIZE - 1] = simulate_tmc_wire_checksum(bytes, DATAGRAM_SIZE - 1);
    memcpy(answer->bytes, bytes, sizeof bytes);
    answer->size = sizeof bytes;
    answer->start_ns = wire->end_ns;
    answer->start_ns += (uint64_t)(send_delay_bits(wire->tmc) * 1e9 / answer->baud);
    answer->baud *= 1.0 + wire->tmc->skew_1000 / 1000.0;
}

static void tell(const simulate_tmc_wire_t *wire, bool is_write, uint32_t value) {
    if (wires.watcher != NULL) {
        wires.watcher(&(simulate_tmc_access_t){.tmc = wire->tmc,
                                               .time_ns = wire->end_ns,
                                               .address = wire->bytes[2] & ~WRITES,
                                               .is_write = is_write,
                                               .value = value});
    }
}

// Carries out the datagram that is complete.
static void obey(simulate_tmc_wire_t *wire, unsigned size, simulate_wire_words_t *answer) {
    const uint8_t *data = wire->bytes + 3;
    unsigned address = wire->bytes[2] & ~WRITES;
    if (wire->bytes[1] != wire->tmc->address) {
        return;
    }
    if (size == DATAGRAM_SIZE) {
        uint32_t value =
            (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
        wire->tmc->writes++;
        simulate_tmc_write(wire->tmc, address, value, wire->end_ns);
        tell(wire, true, value);
    } else if (wire->answers_ns <= wire->end_ns) {
        uint32_t value = simulate_tmc_read(wire->tmc, address, wire->end_ns);
        wire->tmc->reads++;
        answer_with(wire, address, value, answer);
        tell(wire, false, value);
    }
}

// ---- Faults -------------------------------------------------------------------------------------

static bool strikes(simulate_tmc_wire_t *wire, simulate_chip_fault_t fault, uint64_t now_ns) {
    return simulate_faults_strikes(&wire->tmc->faults, fault, now_ns);
}

// Frames that are counted have all of the noise, else it is every second one, more or less.
static bool is_noisy(simulate_tmc_wire_t *wire, uint64_t now_ns) {
    uint32_t frames = wire->tmc->faults.list[SIMULATE_CHIP_GARBLED].frames;
    bool hit = frames != SIMULATE_CHIP_FOR_EVER || (next_random(wire) & 2) != 0;
    return hit && strikes(wire, SIMULATE_CHIP_GARBLED, now_ns);
}

static bool hears_nothing(simulate_tmc_wire_t *wire, uint64_t now_ns) {
    return simulate_faults_active(&wire->tmc->faults, SIMULATE_CHIP_UNPOWERED, now_ns) ||
           strikes(wire, SIMULATE_CHIP_DEAF, now_ns) ||
           strikes(wire, SIMULATE_CHIP_UNPLUGGED, now_ns);
}

static void spoil_answer(simulate_tmc_wire_t *wire, uint64_t now_ns,
                         simulate_wire_words_t *answer) {
    if (strikes(wire, SIMULATE_CHIP_SILENT, now_ns)) {
        answer->size = 0;
    } else if (strikes(wire, SIMULATE_CHIP_BAD_CRC, now_ns)) {
        answer->bytes[DATAGRAM_SIZE - 1] ^= (uint8_t)(1u << next_random(wire) % 8);
    } else if (strikes(wire, SIMULATE_CHIP_LATE, now_ns)) {
        answer->start_ns += LATE_MIN_NS + next_random(wire) % LATE_SPREAD_NS;
    }
}

static void hear_bytes(simulate_tmc_wire_t *wire, const simulate_wire_words_t *words,
                       simulate_wire_words_t *answer) {
    double bit_ns = 1e9 / words->baud;
    for (unsigned i = 0; i < words->size; i++) {
        uint64_t start_ns = words->start_ns + (uint64_t)(i * BYTE_BITS * bit_ns);
        bool stop_bit = (words->no_stop_bytes >> i & 1u) == 0;
        unsigned size = take_byte(wire, words->bytes[i], stop_bit, start_ns, bit_ns);
        if (size > 0) {
            obey(wire, size, answer);
        }
    }
}

bool simulate_tmc_wire_hear(simulate_tmc_wire_t *wire, const simulate_wire_words_t *words,
                            uint64_t end_ns, simulate_wire_words_t *answer) {
    double fastest = wire->tmc->clock_khz * 1000.0 / CLOCKS_A_BIT_MIN;
    bool for_me = words->size > 1 && words->bytes[1] == wire->tmc->address;
    *answer = (simulate_wire_words_t){.baud = words->baud};
    if (words->baud < BAUD_MIN || words->baud > fastest ||
        (for_me && hears_nothing(wire, end_ns))) {
        return false;
    }
    bool noise = for_me && is_noisy(wire, end_ns);
    bool on_the_way_back = noise && words->size == REQUEST_SIZE && (next_random(wire) & 1) != 0;
    simulate_wire_words_t heard = *words;
    if (noise && !on_the_way_back) {
        damage(wire, &heard);
    }
    hear_bytes(wire, &heard, answer);
    if (answer->size > 0 && on_the_way_back) {
        damage(wire, answer);
    } else if (answer->size > 0) {
        spoil_answer(wire, end_ns, answer);
    }
    return answer->size > 0;
}

// ---- The wire -----------------------------------------------------------------------------------

static void say(simulate_tmc_wire_t *wire, const simulate_wire_words_t *answer) {
    double bits = (double)(answer->size * BYTE_BITS);
    wire->answers_ns = answer->start_ns + (uint64_t)(bits * 1e9 / answer->baud);
    simulate_wire_say(wire->listener, answer);
    for (unsigned i = 0; i < wires.count; i++) {
        simulate_wire_words_t none;
        simulate_tmc_wire_t *other = &wires.list[i];
        if (other != wire && other->tmc->tx_gpio == wire->tmc->tx_gpio &&
            send_delay_bits(other->tmc) <= BYTE_BITS) {
            hear_bytes(other, answer, &none);
        }
    }
}

static void on_frame(void *state, const simulate_wire_words_t *words, uint64_t end_ns) {
    simulate_tmc_wire_t *wire = state;
    simulate_wire_words_t answer;
    if (simulate_tmc_wire_hear(wire, words, end_ns, &answer)) {
        say(wire, &answer);
    }
}

bool simulate_tmc_wire_attach(simulate_tmc_t *tmc) {
    if (wires.count == SIMULATE_TMC_MAX) {
        return false;
    }
    simulate_tmc_wire_t *wire = &wires.list[wires.count];
    simulate_wire_listener_t listener = {
        .tx_gpio = tmc->tx_gpio, .rx_gpio = tmc->rx_gpio, .frame = on_frame, .state = wire};
    wire->tmc = tmc;
    wire->random = 0x2545F491u + wires.count;
    wire->listener = simulate_wire_attach(&listener);
    if (wire->listener == SIMULATE_WIRE_LISTENERS_MAX) {
        return false;
    }
    wires.count++;
    return true;
}

void simulate_tmc_wire_run(uint64_t now_ns) {
    for (unsigned i = 0; i < wires.count; i++) {
        simulate_tmc_wire_t *wire = &wires.list[i];
        simulate_chip_fault_t fault = SIMULATE_CHIP_UNPOWERED;
        bool holds = simulate_faults_active(&wire->tmc->faults, fault, now_ns);
        if (holds != wire->holds) {
            wire->holds = holds;
            simulate_wire_hold(wire->listener, holds);
        }
    }
}
