# A part is a folder with a face. Its objects are linked as they are (no archives), because parts call
# each other both ways: the tick is called by the port and asks the port for its pins.

# stepmite_our_code(TARGET): our include paths and flags for this target's own sources (not for those of
# the SDK, which are compiled in the firmware's executable).
function(stepmite_our_code target)
    target_include_directories(${target} PRIVATE
        ${CMAKE_SOURCE_DIR}
        ${CMAKE_SOURCE_DIR}/firmware
        ${CMAKE_SOURCE_DIR}/firmware/port/${STEPMITE_PLATFORM} # hal_port.h
        ${CMAKE_BINARY_DIR}/generated                          # version.h
    )
    target_link_libraries(${target} PRIVATE stepmite_flags)
    if(TARGET stepmite_sdk_headers)
        target_link_libraries(${target} PRIVATE stepmite_sdk_headers)
    endif()
    add_dependencies(${target} stepmite_version)
endfunction()

# stepmite_part(NAME SOURCE...): makes stepmite_NAME from this folder's sources; none yet is fine.
function(stepmite_part name)
    if(NOT ARGN)
        add_library(stepmite_${name} INTERFACE)
        return()
    endif()
    add_library(stepmite_${name} OBJECT ${ARGN})
    stepmite_our_code(stepmite_${name})
endfunction()

# stepmite_link_parts(TARGET PART...): links the objects of these parts into an executable.
function(stepmite_link_parts target)
    foreach(part IN LISTS ARGN)
        target_link_libraries(${target} PRIVATE stepmite_${part})
    endforeach()
endfunction()

# stepmite_executable(TARGET PART...): a host program of these parts.
function(stepmite_executable target)
    add_executable(${target} $<TARGET_OBJECTS:stepmite_main>)
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE C)
    stepmite_link_parts(${target} ${ARGN})
    target_link_libraries(${target} PRIVATE stepmite_flags m)
endfunction()
