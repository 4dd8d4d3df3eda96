# The flash file system, littlefs, at one version: LITTLEFS_DIR (environment or cache), .deps/littlefs, where
# tools/setup puts it, or fetched at the pinned tag. It is linked as the part littlefs; our warnings are not
# meant for it.
set(LITTLEFS_TAG v2.11.2)
set(LITTLEFS_API 0x0002000b)

if(NOT LITTLEFS_DIR AND NOT DEFINED ENV{LITTLEFS_DIR})
    execute_process( # quick if it is there
        COMMAND ${CMAKE_COMMAND} -E env STEPMITE_NO_APT=1 ${CMAKE_SOURCE_DIR}/tools/setup littlefs
        ERROR_QUIET
    )
endif()
include(third_party)
third_party(littlefs LITTLEFS_DIR lfs.c
    https://github.com/littlefs-project/littlefs.git ${LITTLEFS_TAG} ${CMAKE_SOURCE_DIR}/.deps/littlefs
)

file(STRINGS ${LITTLEFS_DIR}/lfs.h littlefs_api REGEX "define LFS_VERSION 0x")
if(NOT littlefs_api MATCHES ${LITTLEFS_API})
    message(FATAL_ERROR "${LITTLEFS_DIR} is not littlefs ${LITTLEFS_TAG}")
endif()

# No heap, nothing printed, and an assertion that returns to us: a damaged image must not end the firmware.
add_library(littlefs_face INTERFACE)
target_include_directories(littlefs_face SYSTEM INTERFACE ${LITTLEFS_DIR})
target_compile_definitions(littlefs_face INTERFACE
    LFS_NO_MALLOC LFS_NO_DEBUG LFS_NO_WARN LFS_NO_ERROR
    LFS_NAME_MAX=63 LFS_DEFINES=files_assert.h
)
target_include_directories(littlefs_face INTERFACE ${CMAKE_SOURCE_DIR}/firmware/files)

add_library(stepmite_littlefs OBJECT ${LITTLEFS_DIR}/lfs.c ${LITTLEFS_DIR}/lfs_util.c)
target_link_libraries(stepmite_littlefs PRIVATE littlefs_face stepmite_sanitizers)
target_compile_options(stepmite_littlefs PRIVATE -w)
