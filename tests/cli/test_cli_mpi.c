/* The same sweep under mpirun: the same bytes, and a rank that dies loses nothing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SWEEP "flux --albedo 0.5:1:40 --g 0,0.5 --thickness 1:10:10 --mu0 0.02:1:50"

/* More ranks than cores, as root where the tests run so, without ssh; $M is the program
 * built with MPI. */
static int setup(void **state) {
    if (program_setup(state) != 0 || setenv("M", PPSCAT_MPI_PROGRAM, 1) != 0)
        return -1;
    return setenv("MPIRUN", PPSCAT_MPIRUN " --oversubscribe", 1) ||
                   setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1) ||
                   setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1) ||
                   setenv("OMPI_MCA_plm", "isolated", 1)
               ? -1
               : 0;
}

static void shell_well(const char *command) {
    result r = program_shell(command);

    if (r.status != 0)
        fail_msg("%s: %s", command, r.err);
    result_free(&r);
}

static void ranks_do_not_change_a_byte(void **state) {
    static const int ranks[] = {1, 2, 4};

    (void)state;
    shell_well("\"$P\" " SWEEP " -j 1 -o serial.csv");
    for (size_t i = 0; i < 3; i++) {
        char line[512];
        snprintf(line, sizeof line,
                 "$MPIRUN -n %d \"$M\" " SWEEP
                 " -o ranks.csv && cmp serial.csv ranks.csv",
                 ranks[i]);
        shell_well(line);
    }
    shell_well("$MPIRUN -n 3 \"$M\" " SWEEP " >shown.csv && cmp serial.csv shown.csv");
}

static void ranks_compare_methods_alike(void **state) {
    const char *sweep = "error --method spp,exact --albedo 0.5:1:9 --mu0 0.1:1:5 "
                        "--streams 16";
    char line[512];

    (void)state;
    snprintf(line, sizeof line,
             "\"$P\" %s | cut -d, -f1-10 >one; $MPIRUN -n 2 \"$M\" %s | cut -d, -f1-10 "
             ">two; cmp one two",
             sweep, sweep);
    shell_well(line);
}

static void refusals_of_all_ranks_are_counted(void **state) {
    result one = program_run("flux --method single,spp --albedo 0:1:50 --sky 1");
    result two = program_shell("$MPIRUN -n 2 \"$M\" flux --method single,spp --albedo "
                               "0:1:50 --sky 1");

    (void)state;
    assert_int_equal(one.status, 3);
    assert_int_equal(two.status, 3);
    assert_string_equal(one.out, two.out);
    assert_int_equal(strncmp(one.err, two.err, strlen(one.err)), 0);
    result_free(&one);
    result_free(&two);
}

static void a_killed_rank_ends_the_run_which_resumes(void **state) {
    bool left = false;

    (void)state;
    shell_well("\"$P\" " SWEEP " -o serial.csv");
    for (double seconds = 0.4; !left && seconds < 20; seconds *= 1.3) {
        char line[1024];
        result r;
        snprintf(line, sizeof line,
                 "rm -f ranks.csv* rank.*\n"
                 "timeout 60 $MPIRUN -n 3 sh -c 'echo $$ >rank.$OMPI_COMM_WORLD_RANK; "
                 "exec \"$M\" " SWEEP " -o ranks.csv' &\n"
                 "while [ ! -s rank.1 ]; do sleep 0.05; done\n"
                 "sleep %.2f; kill -KILL $(cat rank.1) 2>/dev/null; wait $!",
                 seconds);
        r = program_shell(line);
        if (file_exists("ranks.csv.part-journal")) {
            char *journal = read_file("ranks.csv.part-journal");
            assert_int_not_equal(r.status, 0);
            assert_false(file_exists("ranks.csv"));
            left = strstr(journal, "\"units\": 0") == NULL;
            free(journal);
        }
        result_free(&r);
    }
    assert_true(left);
    shell_well("$MPIRUN -n 2 \"$M\" " SWEEP " -o ranks.csv --resume");
    shell_well("cmp serial.csv ranks.csv");
}

static void bad_input_is_told_once(void **state) {
    result r = program_shell("$MPIRUN -n 3 \"$M\" flux --albedo 2");
    const char *first = strstr(r.err, "ppscat: --albedo");

    (void)state;
    assert_int_equal(r.status, 2);
    assert_non_null(first);
    assert_null(strstr(first + 1, "ppscat: --albedo"));
    result_free(&r);
    r = program_shell("$MPIRUN -n 2 \"$M\" flux -j 2");
    assert_int_equal(r.status, 2);
    assert_non_null(strstr(r.err, "ppscat: --jobs: '2'"));
    result_free(&r);
    r = program_shell("$MPIRUN -n 2 \"$M\" methods");
    assert_int_equal(r.status, 0);
    assert_null(strstr(strstr(r.out, "name,") + 1, "name,"));
    result_free(&r);
}

/* Else every rank would write the same file. */
static void a_build_without_mpi_refuses_ranks(void **state) {
    result r = program_shell("$MPIRUN -n 2 \"$P\" flux -o twice.csv");

    (void)state;
#ifdef PPSCAT_WITH_MPI
    result_free(&r);
    skip(); /* this build has it */
#endif
    assert_int_equal(r.status, 2);
    assert_non_null(strstr(r.err, "built without MPI"));
    assert_false(file_exists("twice.csv.part"));
    result_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranks_do_not_change_a_byte),
        cmocka_unit_test(ranks_compare_methods_alike),
        cmocka_unit_test(refusals_of_all_ranks_are_counted),
        cmocka_unit_test(a_killed_rank_ends_the_run_which_resumes),
        cmocka_unit_test(bad_input_is_told_once),
        cmocka_unit_test(a_build_without_mpi_refuses_ranks),
    };

    return cmocka_run_group_tests(tests, setup, program_teardown);
}
