# Compiler flags of our own code (not of the SDK's): every warning is an error, and arithmetic is the
# same on every target (no fused multiply-add), so that the host's step train is the board's.
option(STEPMITE_SANITIZE "Address and undefined-behaviour sanitizers (host only)" OFF)

add_library(stepmite_flags INTERFACE)
target_compile_options(stepmite_flags INTERFACE
    -Wall -Wextra -Wshadow -Wconversion -Wdouble-promotion -Wmissing-prototypes -Werror
    -Wno-format-truncation # messages are meant to be cut at their buffer's end
    -ffp-contract=off -fno-math-errno
)
add_library(stepmite_sanitizers INTERFACE) # also for the libraries in the host program
if(STEPMITE_SANITIZE)
    set(sanitize -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_compile_options(stepmite_sanitizers INTERFACE ${sanitize})
    target_link_options(stepmite_sanitizers INTERFACE ${sanitize})
endif()
target_link_libraries(stepmite_flags INTERFACE stepmite_sanitizers)
