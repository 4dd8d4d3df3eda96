# Unit tests with Unity. Found in UNITY_DIR (environment or cache), as Debian's package cmock brings it,
# or fetched at a pinned tag.
include(third_party)
third_party(unity UNITY_DIR src/unity.c
    https://github.com/ThrowTheSwitch/Unity.git v2.5.2 /usr/share/cmock/vendor/unity
)

add_library(unity STATIC ${UNITY_DIR}/src/unity.c)
target_include_directories(unity SYSTEM PUBLIC ${UNITY_DIR}/src)
target_compile_definitions(unity PUBLIC UNITY_SUPPORT_64 UNITY_INCLUDE_DOUBLE)

# unit_test(SOURCE PART... [SOURCES extra.c ...]): registers tests/unit/SOURCE.c as the ctest SOURCE, linked
# with the objects of these parts and with the extra sources. The test's own main() runs its cases.
#   unit_test(base/test_num base)
function(unit_test source)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES")
    string(REPLACE "/" "_" target unit_${source})
    add_executable(${target} ${source}.c ${arg_SOURCES})
    stepmite_our_code(${target})
    stepmite_link_parts(${target} ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${target} PRIVATE unity m)
    add_test(NAME ${source} COMMAND ${target})
    set_tests_properties(${source} PROPERTIES TIMEOUT 60)
endfunction()
