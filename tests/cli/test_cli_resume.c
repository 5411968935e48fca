/* Never lose a sweep: killed, interrupted, out of disk, resumed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <jansson.h>

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
#define SANITIZED true /* ten times slower, with memory of its own */
#define ALBEDOS "0.5:1:8 "
#else
#define SANITIZED false
#define ALBEDOS "0.5:1:25 "
#endif

enum { KILLS = 20 };

/* About a second of work. */
#define SWEEP "flux --g 0,0.5 --thickness 1:10:60 --mu0 0.02:1:50 --albedo " ALBEDOS
/* A case of it takes minutes. */
#define SLOW "flux --method hemispheric,mc --photons 100000000 --albedo 0.9,0.99 "

/* Start "ppscat ARGUMENTS" in the background, its standard error in `stderr`. */
static pid_t start(const char *arguments) {
    char line[1024];
    pid_t pid;

    snprintf(line, sizeof line, "exec \"$P\" %s 2>stderr", arguments);
    pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        signal(SIGINT, SIG_DFL); /* a background job of a script ignores it */
        execl("/bin/sh", "sh", "-c", line, (char *)NULL);
        _exit(127);
    }
    return pid;
}

static void pause_for(double seconds) {
    struct timespec t = {(time_t)seconds,
                         (long)(1e9 * (seconds - (double)(long)seconds))};

    nanosleep(&t, NULL);
}

static double now(void) {
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void run_well(const char *arguments) {
    result r = program_run(arguments);

    if (r.status != 0)
        print_error("%s: %s", arguments, r.err);
    assert_int_equal(r.status, 0);
    result_free(&r);
}

/* A run that ends with this status and one line that holds `words`. */
static void run_refused(const char *arguments, int status, const char *words) {
    result r = program_run(arguments);

    if (!strstr(r.err, words))
        print_error("%s: %s", arguments, r.err);
    assert_int_equal(r.status, status);
    assert_non_null(strstr(r.err, words));
    result_free(&r);
}

static bool same_files(const char *a, const char *b) {
    char line[256];

    snprintf(line, sizeof line, "cmp %s %s", a, b);
    return system(line) == 0;
}

/* What the sidecar of a file says was used, as text to be freed. */
static char *used_by(const char *sidecar) {
    json_t *json = json_load_file(sidecar, 0, NULL);
    json_t *note = json_array_get(json_object_get(json, "notes"), 0);
    char *text = json_dumps(json_object_get(note, "used"), JSON_SORT_KEYS);

    assert_non_null(text);
    json_decref(json);
    return text;
}

/* Whether a killed run into FILE has left something to go on from. */
static bool something_left(const char *file) {
    char line[256];

    snprintf(line, sizeof line,
             "grep -q '\"units\": [1-9]' %s.part-journal 2>/dev/null", file);
    return system(line) == 0;
}

/* Kill a run into FILE at random moments and resume it, KILLS times; then let it end. The
 * moments follow the time that a run takes. */
static void kill_and_resume(const char *sweep, const char *file, double seconds) {
    char line[512];
    int status, kills = 0, left = 0;

    snprintf(line, sizeof line, "%s -o %s --resume", sweep, file);
    while (kills < KILLS) {
        pid_t pid = start(line);
        pause_for(seconds * (double)rand() / (double)RAND_MAX);
        kill(pid, SIGKILL);
        waitpid(pid, &status, 0);
        kills += WIFSIGNALED(status);
        left += WIFSIGNALED(status) && something_left(file);
        if (WIFEXITED(status)) /* it was done: begin anew */
            assert_true(WEXITSTATUS(status) == 0 && unlink(file) == 0);
    }
    assert_true(left > 0);
    run_well(line);
}

static void a_killed_and_resumed_file_is_the_uninterrupted_one(void **state) {
    char *want, *got;
    double begin = now(), seconds;

    (void)state;
    run_well(SWEEP "-j 1 -o whole.csv");
    seconds = now() - begin;
    kill_and_resume(SWEEP, "killed.csv", 0.5 * seconds);
    assert_true(same_files("whole.csv", "killed.csv"));
    assert_false(file_exists("killed.csv.part"));
    assert_false(file_exists("killed.csv.part-journal"));
    want = used_by("whole.csv-metadata.json");
    got = used_by("killed.csv-metadata.json");
    assert_string_equal(got, want);
    free(want);
    free(got);
}

/* Methods that come together and are written one after the other; all but the times. */
static void a_killed_and_resumed_error_sweep_is_the_uninterrupted_one(void **state) {
    const char *sweep = "error --method spp,single,exact --mu0 0.1:1:60 --streams 16 "
                        "--albedo " ALBEDOS;
    char line[256];
    double begin = now(), seconds;

    (void)state;
    snprintf(line, sizeof line, "%s -j 1 -o whole.csv", sweep);
    run_well(line);
    seconds = now() - begin;
    kill_and_resume(sweep, "killed.csv", 0.7 * seconds);
    assert_int_equal(
        system("cut -d, -f1-10 whole.csv >a; cut -d, -f1-10 killed.csv >b"), 0);
    assert_true(same_files("a", "b"));
    assert_false(file_exists("killed.csv.part-values"));
}

static void an_interrupt_stops_within_a_second_and_says_how_to_go_on(void **state) {
    pid_t pid = start(SLOW "-o 'a b.csv'");
    int status;
    double begin;
    char *said;

    (void)state;
    for (int i = 0; i < 100 && !file_exists("a b.csv.part-journal"); i++)
        pause_for(0.05);
    pause_for(0.3);
    begin = now();
    kill(pid, SIGINT);
    pause_for(1e-3); /* a second one comes with it: timeout, Slurm */
    kill(pid, SIGINT);
    waitpid(pid, &status, 0);
    assert_true(now() - begin < 1);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
    said = read_file("stderr");
    assert_non_null(strstr(said, "6 rows are kept in 'a b.csv.part'"));
    assert_non_null(strstr(said, "-o 'a b.csv' --resume\n"));
    free(said);
}

static void an_interrupted_file_goes_on(void **state) {
    int status;
    pid_t pid;
    double begin = now(), seconds;

    (void)state;
    run_well(SWEEP "-j 1 -o whole.csv");
    seconds = now() - begin;
    pid = start(SWEEP "-o stopped.csv");
    pause_for(0.3 * seconds);
    kill(pid, SIGTERM);
    waitpid(pid, &status, 0);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    assert_true(file_exists("stopped.csv.part"));
    assert_false(file_exists("stopped.csv"));
    run_refused(SWEEP "-o stopped.csv", 2, "--resume"); /* nothing is wiped out */
    run_well(SWEEP "-o stopped.csv --resume");
    assert_true(same_files("whole.csv", "stopped.csv"));
}

/* Leave FILE.part and its journal of a sweep that was interrupted. */
static void leave_part(const char *file) {
    char line[512];
    int status;

    snprintf(line, sizeof line, "rm -f %s*", file);
    assert_int_equal(system(line), 0);
    for (double wait = 0.2; wait < 10; wait *= 1.5) {
        pid_t pid;
        snprintf(line, sizeof line, SWEEP "-j 1 -o %s --resume", file);
        pid = start(line);
        pause_for(wait);
        kill(pid, SIGTERM);
        waitpid(pid, &status, 0);
        if (WIFSIGNALED(status)) {
            snprintf(line, sizeof line, "%s.part", file);
            if (file_exists(line))
                return;
        } else {
            snprintf(line, sizeof line, "rm -f %s*", file);
            assert_int_equal(system(line), 0);
            wait /= 4;
        }
    }
    fail_msg("no part of the file was left");
}

/* The part is as it was: refused, not touched. */
static void refused_and_untouched(const char *arguments, const char *words) {
    assert_int_equal(system("cp cut.csv.part kept.part"), 0);
    run_refused(arguments, 2, words);
    assert_true(same_files("cut.csv.part", "kept.part"));
    assert_false(file_exists("cut.csv"));
}

static void a_part_that_is_not_what_was_left_is_refused(void **state) {
    (void)state;
    leave_part("cut.csv");
    assert_int_equal(system("cp cut.csv.part good; truncate -s -1 cut.csv.part"), 0);
    refused_and_untouched(SWEEP "-o cut.csv --resume", "not what the run left");
    assert_int_equal(system("head -c -1 good >cut.csv.part; echo x >>cut.csv.part"), 0);
    refused_and_untouched(SWEEP "-o cut.csv --resume", "not what the run left");
    assert_int_equal(system("cp good cut.csv.part"), 0);
    refused_and_untouched(SWEEP "-o cut.csv --resume --tol 1e-3", "--tol '1e-6'");
    refused_and_untouched("field -o cut.csv --resume", "'flux', not of 'field'");
    refused_and_untouched("flux -o cut.csv", "unfinished run");
    refused_and_untouched("methods -o cut.csv", "unfinished sweep");
    assert_int_equal(system("cp cut.csv.part-journal good-journal; echo '{}' "
                            ">cut.csv.part-journal"),
                     0);
    refused_and_untouched(SWEEP "-o cut.csv --resume", "no journal of ppscat");
    assert_int_equal(system("rm cut.csv.part-journal"), 0);
    refused_and_untouched(SWEEP "-o cut.csv --resume", "no journal beside it");
    /* and more than the journal knows of is what a killed run leaves */
    assert_int_equal(system("mv good-journal cut.csv.part-journal; echo half a row "
                            ">>cut.csv.part"),
                     0);
    run_well(SWEEP "-o cut.csv --resume");
    run_well(SWEEP "-o whole.csv");
    assert_true(same_files("whole.csv", "cut.csv"));
}

/* A small file system of our own; skipped where we may not mount one. */
static void mount_small(const char *options) {
    char line[256];

    assert_int_equal(system("mkdir -p small"), 0);
    snprintf(line, sizeof line, "mount -t tmpfs -o %s none small 2>/dev/null", options);
    if (system(line) != 0) {
        print_message("skipped: a tmpfs cannot be mounted here\n");
        skip();
    }
}

static int unmount_small(void **state) {
    (void)state;
    return system("umount -l small 2>/dev/null || true");
}

static void a_full_disk_loses_nothing(void **state) {
    result r;

    (void)state;
    mount_small(SANITIZED ? "size=1m" : "size=2m");
    r = program_run(SWEEP "-o small/full.csv");
    assert_int_equal(r.status, 1);
    assert_non_null(strstr(r.err, "No space left"));
    assert_non_null(strstr(r.err, "-o small/full.csv --resume"));
    assert_false(file_exists("small/full.csv"));
    result_free(&r);
    assert_int_equal(system("mount -o remount,size=64m small"), 0);
    run_well(SWEEP "-o small/full.csv --resume");
    run_well(SWEEP "-o whole.csv");
    assert_true(same_files("whole.csv", "small/full.csv"));
}

static void a_read_only_folder_is_exit_2(void **state) {
    (void)state;
    mount_small("ro");
    run_refused(SWEEP "-o small/file.csv", 2, "Read-only file system");
    run_refused(SWEEP "-o small/file.csv --resume", 2, "Read-only file system");
}

static void a_closed_pipe_ends_the_sweep(void **state) {
    double begin = now();
    result r = program_shell("{ \"$P\" flux --method hemispheric --albedo 0:1:50000 "
                             "--mu0 0.1:1:50000; echo $? >code; } | head -n 3");
    char *code = read_file("code");

    (void)state;
    assert_true(now() - begin < 10); /* of 7.5e9 rows */
    assert_string_equal(code, "1\n");
    assert_int_equal(count_lines(r.out), 3);
    assert_non_null(strstr(r.err, "Broken pipe"));
    free(code);
    result_free(&r);
}

/* The largest memory of all children so far, in MiB. */
static double peak_memory(void) {
    struct rusage usage;

    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/* Many small cases, few large ones, one that is larger than a unit, and all of them in
 * the order of `error`: 1e7, 1e7, 3e6 rows and 1e5. */
static void memory_stays_bounded(void **state) {
    static const char *const sweeps[] = {
        "flux --method hemispheric --albedo 0:1:1000 --mu0 0.001:1:1000 --depth "
        "0:1:10 -o /dev/null",
        "field --method spp --mu0 0.1,1 --depth 0:1:50 --mu 0.001:1:1000 --phi "
        "0:180:100 "
        "-o /dev/null",
        "field --streams 8 --depth 0:1:30 --mu 0.001:1:1000 --phi 0:180:100 -o "
        "/dev/null",
        "error --method spp,hemispheric --streams 8 --albedo 0:1:50 --mu0 0.001:1:50 "
        "--mu "
        "0.5 --phi 0 -o /dev/null",
    };

    (void)state;
    if (SANITIZED) {
        print_message("skipped: a sanitizer has memory of its own\n");
        skip();
    }
    for (size_t i = 0; i < sizeof sweeps / sizeof sweeps[0]; i++) {
        result r = program_run(sweeps[i]);
        assert_true(r.status == 0 || r.status == 3);
        result_free(&r);
        if (peak_memory() >= 200)
            fail_msg("%.0f MiB for %s", peak_memory(), sweeps[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_stays_bounded),
        cmocka_unit_test(a_killed_and_resumed_file_is_the_uninterrupted_one),
        cmocka_unit_test(a_killed_and_resumed_error_sweep_is_the_uninterrupted_one),
        cmocka_unit_test(an_interrupt_stops_within_a_second_and_says_how_to_go_on),
        cmocka_unit_test(an_interrupted_file_goes_on),
        cmocka_unit_test(a_part_that_is_not_what_was_left_is_refused),
        cmocka_unit_test_teardown(a_full_disk_loses_nothing, unmount_small),
        cmocka_unit_test_teardown(a_read_only_folder_is_exit_2, unmount_small),
        cmocka_unit_test(a_closed_pipe_ends_the_sweep),
    };

    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
