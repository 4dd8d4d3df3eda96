# stepmite_firmware_image(TARGET MAIN PART...): TARGET.elf and TARGET.uf2. MAIN is the object library with main().
function(stepmite_firmware_image target main)
    add_executable(${target} $<TARGET_OBJECTS:${main}>)
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE C)
    stepmite_link_parts(${target} ${ARGN})
    target_link_libraries(${target} PRIVATE ${STEPMITE_SDK_LIBRARIES} pico_stdio_usb m)
    target_compile_definitions(${target} PRIVATE ${STEPMITE_SDK_DEFINITIONS})

    # No printf at all: ours is format_text() of base, which needs no heap.
    pico_set_printf_implementation(${target} none)

    # main() on a stack of its own (rp2_memory.c), and an end of the image below the storage (rp2_storage.c).
    set(port ${CMAKE_SOURCE_DIR}/firmware/port/rp2)
    set(scripts ${port}/rp2_memory.ld ${port}/rp2_storage.ld)
    target_link_options(${target} PRIVATE -Wl,--wrap=main ${scripts})
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${scripts})

    # For `picotool info`; the version is in rp2_system.c.
    pico_set_program_name(${target} "StepMite")
    pico_set_program_description(${target} "4-axis motion controller with a BASIC prompt")
    pico_add_extra_outputs(${target})
endfunction()
