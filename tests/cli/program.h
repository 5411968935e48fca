/* Running the built ppscat in a folder of its own, and reading what it wrote.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TESTS_CLI_PROGRAM_H
#define PPSCAT_TESTS_CLI_PROGRAM_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* the four above are what cmocka.h wants before it */
#include <cmocka.h>

#include <stdbool.h>

/* What a run left; free with result_free. */
typedef struct {
    int status; /* exit status, -1 when killed */
    char *out, *err;
} result;

/* Fixtures of a group of tests: enter a new folder, leave and remove it. */
int program_setup(void **state);
int program_teardown(void **state);

/* Run "ppscat ARGUMENTS" through the shell, which takes quotes and redirections. */
result program_run(const char *arguments);

/* Run any shell command in which $P is the program. */
result program_shell(const char *command);

void result_free(result *r);

/* The whole file as text; NULL where it does not exist. Free it. */
char *read_file(const char *path);

bool file_exists(const char *path);

size_t count_lines(const char *text);

/* Field i of the line, to be freed; commas inside quotes are not looked for. */
char *csv_field(const char *line, size_t i);

/* The line that follows, or NULL after the last. */
const char *next_line(const char *line);

#endif
