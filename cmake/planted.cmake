# Faults planted in our sources, for tests that have to find them.

# stepmite_plant(RESULT NAME SOURCE SED): makes a copy of a source file with a fault in it and puts its path
# into RESULT. The sed expression sees the whole file as one line. If it does not fit the file any more the
# build fails. NAME makes the copy's folder.
function(stepmite_plant result name source expression)
    get_filename_component(file ${source} NAME)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/planted/${name})
    add_custom_command(OUTPUT ${folder}/${file}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
        COMMAND sed -E -z "${expression}" ${source} > ${folder}/${file}
        COMMAND sh -c "! cmp -s $0 $1 || { echo \"$2 does not fit $0 any more\" >&2; rm $1; exit 1; }"
            ${source} ${folder}/${file} "The fault planted as ${name}"
        DEPENDS ${source} VERBATIM
    )
    set(${result} ${folder}/${file} PARENT_SCOPE)
endfunction()
