# The one place of warnings: link `ppscat_warnings` PRIVATE to every target of ours.
add_library(ppscat_warnings INTERFACE)
target_compile_options(ppscat_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wvla
    -Wstrict-prototypes -Wmissing-prototypes)
