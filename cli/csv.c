/* Writing CSV, to standard output or to a file that appears complete or not at all.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "csv.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli.h"
#include "number.h"

enum { BUFFER_SIZE = 1 << 16 };

size_t csv_format(double x, char text[CSV_NUMBER_SIZE]) {
    size_t length = number_format(x, text);

    text[length] = '\0';
    return length;
}

static int unwritable(const char *path) {
    return cli_usage("--output: cannot write '%.200s': %s", path, strerror(errno));
}

/* "FILE.part"; NULL without memory. */
static char *part_name(const char *path) {
    size_t size = strlen(path) + sizeof ".part";
    char *part = malloc(size);

    if (part)
        snprintf(part, size, "%s.part", path);
    return part;
}

static int open_file(csv_file *csv, const char *path) {
    struct stat status;
    bool exists = stat(path, &status) == 0;
    bool folder = exists && S_ISDIR(status.st_mode);
    bool in_place = exists && !S_ISREG(status.st_mode);

    if (folder || (exists && access(path, W_OK) != 0)) {
        errno = folder ? EISDIR : errno;
        return unwritable(path);
    }
    csv->path = path;
    if (!in_place) {
        csv->part = part_name(path);
        if (!csv->part)
            return cli_no_memory();
    }
    csv->file = fopen(in_place ? path : csv->part, "w");
    if (csv->file)
        return CLI_DONE;
    free(csv->part);
    csv->part = NULL;
    return unwritable(path);
}

int csv_open(csv_file *csv, const char *path) {
    *csv = (csv_file){.file = stdout};
    if (path && !*path)
        return cli_usage("--output: the name of the file is empty");
    if (path) {
        int rc = open_file(csv, path);
        if (rc != CLI_DONE)
            return rc;
    }
    setvbuf(csv->file, NULL, _IOFBF, BUFFER_SIZE);
    return CLI_DONE;
}

bool csv_broken(const csv_file *csv) { return csv->error != 0; }

static void put(csv_file *csv, const char *text, size_t length) {
    errno = 0;
    if (!csv->error && length && fwrite(text, 1, length, csv->file) != length)
        csv->error = errno ? errno : EIO;
}

static void begin_field(csv_file *csv) {
    if (csv->row_begun)
        put(csv, ",", 1);
    csv->row_begun = true;
}

void csv_text(csv_file *csv, const char *text) {
    begin_field(csv);
    if (!strpbrk(text, ",\"\r\n")) {
        put(csv, text, strlen(text));
        return;
    }
    put(csv, "\"", 1);
    for (; *text; text++) {
        if (*text == '"')
            put(csv, "\"", 1);
        put(csv, text, 1);
    }
    put(csv, "\"", 1);
}

void csv_number(csv_file *csv, double x) {
    char text[CSV_NUMBER_SIZE];
    size_t length = csv_format(x, text);

    begin_field(csv);
    put(csv, text, length);
}

void csv_fields(csv_file *csv, const char *fields) {
    begin_field(csv);
    put(csv, fields, strlen(fields));
}

void csv_end_row(csv_file *csv) {
    put(csv, "\n", 1);
    csv->row_begun = false;
}

static int report(const csv_file *csv) {
    return cli_failed("cannot write %.200s: %s",
                      csv->path ? csv->path : "standard output", strerror(csv->error));
}

int csv_finish(csv_file *csv) {
    errno = 0;
    if (!csv->error && fflush(csv->file) != 0)
        csv->error = errno ? errno : EIO;
    errno = 0;
    if (csv->path) { /* some file systems report a full disk only here */
        if (fclose(csv->file) != 0 && !csv->error)
            csv->error = errno ? errno : EIO;
        csv->file = NULL;
    }
    return csv->error ? report(csv) : CLI_DONE;
}

int csv_publish(csv_file *csv) {
    if (!csv->part)
        return CLI_DONE;
    if (rename(csv->part, csv->path) != 0) {
        csv->error = errno;
        return report(csv);
    }
    free(csv->part);
    csv->part = NULL;
    return CLI_DONE;
}

void csv_close(csv_file *csv) {
    if (csv->file && csv->path)
        fclose(csv->file);
    csv->file = NULL;
    if (csv->part)
        unlink(csv->part);
    free(csv->part);
    csv->part = NULL;
}
