# Finds the pico-sdk, at one version: PICO_SDK_PATH (environment or cache), Debian's pico-sdk-source, or
# fetched at the pinned tag. To be included before project(). SDK headers reach our code by the target
# stepmite_sdk_headers, as system headers: our warnings are not meant for them.
set(PICO_SDK_VERSION_NEEDED 2.1.1)

include(third_party)
third_party(pico_sdk PICO_SDK_PATH pico_sdk_init.cmake
    https://github.com/raspberrypi/pico-sdk.git ${PICO_SDK_VERSION_NEEDED} /usr/src/pico-sdk
    GIT_SUBMODULES lib/tinyusb
)

include(${PICO_SDK_PATH}/pico_sdk_init.cmake)
if(NOT PICO_SDK_VERSION_STRING VERSION_EQUAL PICO_SDK_VERSION_NEEDED)
    message(FATAL_ERROR
        "${PICO_SDK_PATH} has pico-sdk ${PICO_SDK_VERSION_STRING}, needed is ${PICO_SDK_VERSION_NEEDED}")
endif()

# What the port links.
set(STEPMITE_SDK_LIBRARIES
    pico_stdlib pico_bootrom
    hardware_adc hardware_exception hardware_flash hardware_gpio hardware_i2c hardware_irq hardware_pio hardware_pwm hardware_spi hardware_sync hardware_timer hardware_uart
    hardware_watchdog
)

# Settings of the SDK, for its sources and for its headers in ours.
set(STEPMITE_SDK_DEFINITIONS
    PICO_STACK_SIZE=0x1000          # of interrupts: all of the memory bank it is in
    PICO_HEAP_SIZE=4                # nobody allocates (tools/audit/heap.py); 0 draws a warning
    PICO_PANIC_FUNCTION=rp2_fault_panic
    PICO_STDIO_USB_LOW_PRIORITY_IRQ=FIRST_USER_IRQ+1 # RP2_USB_IRQ of hal_port.h
    PICO_STDIO_USB_ENABLE_RESET_VIA_BAUD_RATE=0      # rp2_usb.c does it, but not while motors turn
    CFG_TUD_CDC_RX_BUFSIZE=1024
    CFG_TUD_CDC_TX_BUFSIZE=2048
    USBD_MANUFACTURER="StepMite"
    USBD_PRODUCT="StepMite"
)

# To be called after pico_sdk_init(): the include paths and definitions of those libraries, nothing to link.
function(stepmite_define_sdk_headers)
    add_library(stepmite_sdk_headers INTERFACE)
    target_compile_definitions(stepmite_sdk_headers INTERFACE ${STEPMITE_SDK_DEFINITIONS})
    foreach(library IN LISTS STEPMITE_SDK_LIBRARIES ITEMS pico_stdio_usb tinyusb_device_unmarked)
        target_include_directories(stepmite_sdk_headers SYSTEM INTERFACE
            $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
        target_compile_definitions(stepmite_sdk_headers INTERFACE
            $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>)
    endforeach()
endfunction()
