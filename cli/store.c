/* Where bytes go.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli.h"
#include "system.h"

static int unwritable(const char *path) {
    return cli_usage("--output: cannot write '%.200s': %s", path, strerror(errno));
}

static int failed(const store *s) {
    return cli_failed("cannot write %.200s: %s", s->name, strerror(errno));
}

int store_look(const char *path, bool *regular) {
    struct stat status;
    bool exists = stat(path, &status) == 0;
    bool folder = exists && S_ISDIR(status.st_mode);

    *regular = !exists || S_ISREG(status.st_mode);
    if (!*path)
        return cli_usage("--output: the name of the file is empty");
    if (folder || (exists && access(path, W_OK) != 0)) {
        errno = folder ? EISDIR : errno;
        return unwritable(path);
    }
    return CLI_DONE;
}

int store_stream(store *s, const char *path) {
    *s = (store){.fd = STDOUT_FILENO, .name = path ? path : "standard output"};
    if (path)
        s->fd = open(path, O_WRONLY | O_CLOEXEC);
    return s->fd >= 0 ? CLI_DONE : unwritable(path);
}

int store_file(store *s, const char *name, uint64_t keep) {
    *s = (store){.name = name, .bytes = keep};
    s->fd = open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (s->fd < 0)
        return unwritable(name);
    if (ftruncate(s->fd, (off_t)keep) != 0 || lseek(s->fd, (off_t)keep, SEEK_SET) < 0) {
        unwritable(name);
        close(s->fd);
        return CLI_USAGE;
    }
    return CLI_DONE;
}

int store_temporary(store *s) {
    const char *folder = getenv("TMPDIR");
    char name[4096];

    *s = (store){.name = "a temporary file"};
    snprintf(name, sizeof name, "%s/ppscat-XXXXXX",
             folder && *folder ? folder : "/tmp");
    s->fd = mkstemp(name);
    if (s->fd < 0)
        return failed(s);
    unlink(name);
    return CLI_DONE;
}

int store_write(store *s, const void *data, size_t n) {
    const char *at = data;
    size_t left = n;

    while (left) {
        ssize_t done = write(s->fd, at, left);
        if (done < 0 && errno == EINTR && !system_signal())
            continue;
        if (done < 0 && errno == EINTR)
            return CLI_FAILED;
        if (done < 0)
            return failed(s);
        at += done;
        left -= (size_t)done;
    }
    s->bytes += n;
    return CLI_DONE;
}

int store_read(const store *s, uint64_t at, void *data, size_t n) {
    char *to = data;

    while (n) {
        ssize_t done = pread(s->fd, to, n, (off_t)at);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return cli_failed("cannot read %.200s: %s", s->name,
                              done ? strerror(errno) : "it is too short");
        to += done;
        at += (uint64_t)done;
        n -= (size_t)done;
    }
    return CLI_DONE;
}

void store_trim(store *s) {
    if (ftruncate(s->fd, (off_t)s->bytes) == 0)
        lseek(s->fd, (off_t)s->bytes, SEEK_SET);
}

/* A stream cannot be synchronised: EINVAL. */
int store_sync(const store *s) {
    if (fdatasync(s->fd) != 0 && errno != EINVAL && errno != EROFS)
        return failed(s);
    return CLI_DONE;
}

int store_close(store *s) {
    int fd = s->fd;

    s->fd = -1;
    if (fd >= 0 && close(fd) != 0)
        return failed(s);
    return CLI_DONE;
}

/* The new name is an entry of the folder, which has a cache of its own. */
int store_rename(const char *from, const char *to) {
    char folder[4096];
    char *slash;
    int fd;

    if (rename(from, to) != 0)
        return cli_failed("cannot write %.200s: %s", to, strerror(errno));
    snprintf(folder, sizeof folder, "%s", to);
    slash = strrchr(folder, '/');
    if (slash)
        slash[slash == folder] = '\0';
    fd = open(slash ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        fsync(fd); /* not every file system can */
        close(fd);
    }
    return CLI_DONE;
}
