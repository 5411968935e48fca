# Files with loops for the vector units (core/vector.h): `ppscat_vector_sources(FILE...)`
# in the folder of those files. The flags change no result: nothing is re-associated. (-Wno-psabi: no vector is passed between files.)
include(CheckCSourceCompiles)
check_c_source_compiles("
    #if defined(__clang__) || !defined(__x86_64__)
    #error not here
    #endif
    __attribute__((target_clones(\"default\", \"arch=x86-64-v3\", \"arch=x86-64-v4\")))
    int twice(int i) { return 2 * i; }
    int main(void) { return twice(0); }" PPSCAT_TARGET_CLONES)
if(PPSCAT_TARGET_CLONES)
    target_compile_definitions(ppscat_objects PRIVATE PPS_HAVE_TARGET_CLONES)
endif()

function(ppscat_vector_sources)
    set_source_files_properties(${ARGN}
        TARGET_DIRECTORY ppscat_objects
        PROPERTIES COMPILE_OPTIONS "-O3;-fno-math-errno;-fno-trapping-math;-Wno-psabi")
endfunction()
