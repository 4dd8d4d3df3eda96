// The I2C controllers as masters. Main fills and empties their FIFOs; when it is late the
// controller holds the clock, so nothing is lost. Context: main.
#include "hal/hal_i2c.h"

#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/gpio.h"
#include "hardware/i2c.h"

#define FIFO_SIZE 16u
#define CLOCKS_TO_FREE 9u // end any byte a device is in the middle of
#define HALF_CLOCK_US 5u

static struct {
    uint16_t khz;
    uint16_t address; // of the last transfer
    uint8_t sda_gpio, scl_gpio;
    bool held; // the last transfer ended without a stop
} ports[HAL_I2C_PORTS];

// The transfer under way.
static struct {
    hal_i2c_transfer_t is;
    size_t asked; // bytes sent or asked for
    size_t got;   // bytes received
    bool refused;
} transfer;

static i2c_hw_t *hw_of(unsigned port) {
    return i2c_get_hw(I2C_INSTANCE(port));
}

// ---- Lines --------------------------------------------------------------------------------------

// Low, or left to the pull-up.
static void drive(unsigned gpio, bool low) {
    gpio_set_dir(gpio, low ? GPIO_OUT : GPIO_IN);
    hal_wait_us(HALF_CLOCK_US);
}

// Clocks for a device that holds the data line, then a stop.
static void free_lines(unsigned sda_gpio, unsigned scl_gpio) {
    hal_pin_input(sda_gpio, HAL_PULL_UP);
    hal_pin_input(scl_gpio, HAL_PULL_UP);
    hal_wait_us(HALF_CLOCK_US);
    if (gpio_get(sda_gpio)) {
        return;
    }
    gpio_put(sda_gpio, false);
    gpio_put(scl_gpio, false);
    for (unsigned i = 0; i < CLOCKS_TO_FREE && !gpio_get(sda_gpio); i++) {
        drive(scl_gpio, true);
        drive(scl_gpio, false);
    }
    drive(scl_gpio, true);
    drive(sda_gpio, true);
    drive(scl_gpio, false);
    drive(sda_gpio, false);
}

static void set_up(unsigned port) {
    unsigned sda_gpio = ports[port].sda_gpio;
    unsigned scl_gpio = ports[port].scl_gpio;
    ports[port].held = false;
    i2c_init(I2C_INSTANCE(port), ports[port].khz * 1000u);
    free_lines(sda_gpio, scl_gpio);
    gpio_set_function(sda_gpio, GPIO_FUNC_I2C);
    gpio_set_function(scl_gpio, GPIO_FUNC_I2C);
}

void hal_i2c_open(unsigned port, unsigned sda_gpio, unsigned scl_gpio, uint32_t khz) {
    ports[port].sda_gpio = (uint8_t)sda_gpio;
    ports[port].scl_gpio = (uint8_t)scl_gpio;
    ports[port].khz = (uint16_t)khz;
    set_up(port);
}

void hal_i2c_close(unsigned port) {
    i2c_deinit(I2C_INSTANCE(port));
}

void hal_i2c_abort(unsigned port) {
    i2c_deinit(I2C_INSTANCE(port));
    set_up(port);
}

// ---- Transfers ----------------------------------------------------------------------------------

void hal_i2c_start(unsigned port, const hal_i2c_transfer_t *next) {
    i2c_hw_t *hw = hw_of(port);
    transfer.is = *next;
    transfer.asked = transfer.got = 0;
    transfer.refused = false;
    if (!ports[port].held || ports[port].address != next->address) {
        hw->enable = 0; // or the address could not be changed
        hw_write_masked(&hw->con, next->ten_bits ? I2C_IC_CON_IC_10BITADDR_MASTER_BITS : 0,
                        I2C_IC_CON_IC_10BITADDR_MASTER_BITS);
        hw->tar = next->address;
        hw->enable = 1;
    }
    ports[port].address = next->address;
    (void)hw->clr_intr;
    (void)hw->clr_stop_det;
}

// One command to the controller for each byte.
static void ask(const i2c_hw_t *hw, volatile uint32_t *command, bool restart) {
    bool reads = transfer.is.send == NULL;
    while (transfer.asked < transfer.is.size && (hw->status & I2C_IC_STATUS_TFNF_BITS) != 0 &&
           (!reads || transfer.asked - transfer.got < FIFO_SIZE)) {
        uint32_t word = reads ? I2C_IC_DATA_CMD_CMD_BITS : transfer.is.send[transfer.asked];
        if (restart && transfer.asked == 0) {
            word |= I2C_IC_DATA_CMD_RESTART_BITS;
        }
        transfer.asked++;
        if (transfer.asked == transfer.is.size && !transfer.is.keep) {
            word |= I2C_IC_DATA_CMD_STOP_BITS;
        }
        *command = word;
    }
}

// Bytes beyond what was asked for do not come.
static void take(i2c_hw_t *hw) {
    while (hw->rxflr > 0 && transfer.got < transfer.is.size) {
        transfer.is.receive[transfer.got++] = (uint8_t)hw->data_cmd;
    }
}

static bool is_over(const i2c_hw_t *hw) {
    bool reads = transfer.is.send == NULL;
    if (transfer.asked < transfer.is.size || (reads && transfer.got < transfer.is.size)) {
        return false;
    }
    uint32_t sign = !transfer.is.keep ? I2C_IC_RAW_INTR_STAT_STOP_DET_BITS
                    : reads           ? 0
                                      : I2C_IC_RAW_INTR_STAT_TX_EMPTY_BITS;
    return (hw->raw_intr_stat & sign) == sign;
}

hal_i2c_state_t hal_i2c_poll(unsigned port) {
    i2c_hw_t *hw = hw_of(port);
    if ((hw->raw_intr_stat & I2C_IC_RAW_INTR_STAT_TX_ABRT_BITS) != 0) {
        transfer.refused = true;
        (void)hw->clr_tx_abrt; // the FIFO takes commands again, but there will be none
    }
    if (transfer.refused) { // the controller makes a stop of its own
        if ((hw->status & I2C_IC_STATUS_MST_ACTIVITY_BITS) != 0) {
            return HAL_I2C_BUSY;
        }
        ports[port].held = false;
        return HAL_I2C_NO_ACKNOWLEDGE;
    }
    ask(hw, &hw->data_cmd, ports[port].held);
    if (transfer.is.send == NULL) {
        take(hw);
    }
    if (!is_over(hw) || (hw->raw_intr_stat & I2C_IC_RAW_INTR_STAT_TX_ABRT_BITS) != 0) {
        return HAL_I2C_BUSY;
    }
    ports[port].held = transfer.is.keep;
    return HAL_I2C_DONE;
}
