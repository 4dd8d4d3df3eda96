# Sources of others, at one version each.

# third_party(NAME VARIABLE FILE REPOSITORY TAG FOLDER [OPTION...]): sets VARIABLE to the folder that holds
# FILE: what the cache or the environment says, else FOLDER if FILE is there, else fetched from REPOSITORY at TAG,
# with further options for FetchContent.
macro(third_party name variable file repository tag folder)
    if(NOT ${variable} AND DEFINED ENV{${variable}})
        set(${variable} $ENV{${variable}})
    endif()
    if(NOT ${variable} AND EXISTS ${folder}/${file})
        set(${variable} ${folder})
    endif()
    if(NOT ${variable})
        include(FetchContent)
        FetchContent_Declare(${name} GIT_REPOSITORY ${repository} GIT_TAG ${tag} ${ARGN})
        FetchContent_GetProperties(${name})
        if(NOT ${name}_POPULATED)
            message(STATUS "Fetching ${name} ${tag}")
            FetchContent_Populate(${name})
        endif()
        set(${variable} ${${name}_SOURCE_DIR})
    endif()
    set(${variable} ${${variable}} CACHE PATH "${name} ${tag}, with ${file}")
endmacro()
