# The firmware's version, from `git describe`, as `#define STEPMITE_VERSION "..."` in version.h.
# Looked up at every build; the header changes only if the version did, so nothing else is rebuilt.
# This file is both: included, it makes the target; run with `cmake -P`, it writes the header.
if(CMAKE_SCRIPT_MODE_FILE)
    cmake_minimum_required(VERSION 3.21)
    execute_process(
        COMMAND git describe --always --dirty --tags
        WORKING_DIRECTORY ${SOURCE_DIR}
        OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
    )
    if(NOT version)
        set(version "unknown") # a source archive, or git is not installed
    endif()
    file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define STEPMITE_VERSION \"@version@\"\n" @ONLY)
    return()
endif()

set(version_header ${CMAKE_BINARY_DIR}/generated/version.h)
add_custom_target(stepmite_version
    COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${version_header}
            -P ${CMAKE_CURRENT_LIST_FILE}
    BYPRODUCTS ${version_header}
    COMMENT "Looking up the version"
)
