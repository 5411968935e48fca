/* Running the preview and reading what it measured.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview_bench.h"

#include <limits.h>
#include <math.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli.h"

enum { MAX_ARGUMENTS = 20 };

extern char **environ;

/* Where the preview is: beside this program, where a build puts it, or in PATH. */
static void find_program(char path[PATH_MAX]) {
    static const char *const beside[] = {"ppscat-preview", "../preview/ppscat-preview"};
    char folder[PATH_MAX - 64];
    ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);

    folder[length > 0 ? length : 0] = '\0';
    if (strrchr(folder, '/'))
        *strrchr(folder, '/') = '\0';
    for (size_t i = 0; i < sizeof beside / sizeof beside[0]; i++) {
        snprintf(path, PATH_MAX, "%s/%s", folder, beside[i]);
        if (access(path, X_OK) == 0)
            return;
    }
    snprintf(path, PATH_MAX, "ppscat-preview");
}

/* Start it with its standard output in a pipe; the end to read, or NULL. */
static FILE *start(const char *const *arguments, pid_t *child) {
    char path[PATH_MAX], *argv[MAX_ARGUMENTS] = {path, (char[]){"--bench"}};
    posix_spawn_file_actions_t actions;
    int ends[2], failed = 1;

    find_program(path);
    for (size_t i = 0; arguments[i] && i + 3 < MAX_ARGUMENTS; i++)
        argv[i + 2] = (char *)(uintptr_t)arguments[i]; /* not written to */
    if (pipe(ends) != 0)
        return NULL;
    if (posix_spawn_file_actions_init(&actions) == 0) {
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addclose(&actions, ends[0]);
        posix_spawn_file_actions_addclose(&actions, ends[1]);
        failed = posix_spawnp(child, path, &actions, NULL, argv, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    close(ends[1]);
    if (failed)
        close(ends[0]);
    return failed ? NULL : fdopen(ends[0], "r");
}

/* The header row and what else is none of them is passed over. */
static void read_rows(FILE *file, preview_times *out) {
    const size_t most = sizeof out->row / sizeof out->row[0];
    char line[400];

    while (out->n < most && fgets(line, sizeof line, file)) {
        preview_time *r = &out->row[out->n];
        int fields =
            sscanf(line, "%d,%59[^,],%lf,%*f,%*f,%*u,%zu,%zu,%*d,%*d,%*d,\"%99[^\"]",
                   &r->step, r->work, &r->ms, &r->triangles, &r->cells, r->renderer);
        out->n += fields == 6;
    }
    while (fgets(line, sizeof line, file)) {
    }
}

int preview_bench(const char *const *arguments, preview_times *out, const char **why) {
    pid_t child;
    int status = 0;
    FILE *file = start(arguments, &child);

    out->n = 0;
    *why = "ppscat-preview is not there";
    if (!file)
        return CLI_REFUSED;
    read_rows(file, out);
    fclose(file);
    *why = "ppscat-preview failed";
    return waitpid(child, &status, 0) == child && WIFEXITED(status) &&
                   WEXITSTATUS(status) == 0 && out->n > 0
               ? CLI_DONE
               : CLI_REFUSED;
}

double preview_ms(const preview_times *times, const char *work) {
    for (size_t i = 0; i < times->n; i++) {
        if (strcmp(times->row[i].work, work) == 0)
            return times->row[i].ms;
    }
    return (double)NAN;
}
