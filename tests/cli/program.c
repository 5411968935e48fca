/* Running the built ppscat in a folder of its own.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/ppscat-test-XXXXXX";

int program_setup(void **state) {
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 && setenv("P", PPSCAT_PROGRAM, 1) == 0
               ? 0
               : -1;
}

int program_teardown(void **state) {
    char command[64];

    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

result program_shell(const char *command) {
    char line[5000];
    result r;
    int status, length = snprintf(line, sizeof line,
                                  "{ %s\n} >stdout 2>stderr </dev/null", command);

    assert_in_range(length, 0, sizeof line - 1);
    status = system(line);
    r.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    r.out = read_file("stdout");
    r.err = read_file("stderr");
    assert_non_null(r.out);
    assert_non_null(r.err);
    return r;
}

result program_run(const char *arguments) {
    char line[4096];

    snprintf(line, sizeof line, "\"$P\" %s", arguments);
    return program_shell(line);
}

void result_free(result *r) {
    free(r->out);
    free(r->err);
}

char *read_file(const char *path) {
    FILE *file = fopen(path, "rb");
    size_t n = 0, got;
    char *text = NULL;

    if (!file)
        return NULL;
    do {
        text = realloc(text, n + 65537);
        assert_non_null(text);
        got = fread(text + n, 1, 65536, file);
        n += got;
    } while (got);
    text[n] = '\0';
    fclose(file);
    return text;
}

bool file_exists(const char *path) { return access(path, F_OK) == 0; }

size_t count_lines(const char *text) {
    size_t n = 0;

    for (; *text; text++)
        n += *text == '\n';
    return n;
}

char *csv_field(const char *line, size_t i) {
    char *field;
    size_t length;

    for (; i > 0; i--)
        line += strcspn(line, ",\n") + 1;
    length = strcspn(line, ",\n");
    field = calloc(length + 1, 1);
    assert_non_null(field);
    memcpy(field, line, length);
    return field;
}

const char *next_line(const char *line) {
    const char *end = strchr(line, '\n');

    return end && end[1] ? end + 1 : NULL;
}
