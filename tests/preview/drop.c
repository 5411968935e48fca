/* A hand that drops a file on a window: what the source of a drag does (XDND, version 5).
 *   drop WINDOW PATH; exit 0: the window has taken it
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <X11/Xatom.h>
#include <X11/Xlib.h>

enum { PATIENCE = 30, VERSION = 5 }; /* seconds */

typedef struct {
    Display *display;
    Window source, target;
    Atom list; /* of URIs */
    char uri[8192];
} drag;

static Atom atom(const drag *d, const char *name) {
    return XInternAtom(d->display, name, False);
}

static void tell(const drag *d, const char *what, long b, long c, long e) {
    XEvent event = {.xclient = {.type = ClientMessage,
                                .display = d->display,
                                .window = d->target,
                                .message_type = atom(d, what),
                                .format = 32,
                                .data.l = {(long)d->source, b, c, CurrentTime, e}}};
    XSendEvent(d->display, d->target, False, NoEventMask, &event);
    XFlush(d->display);
}

/* The file's name as the target asks for it. */
static void answer(const drag *d, const XSelectionRequestEvent *asked) {
    XEvent event = {.xselection = {.type = SelectionNotify,
                                   .display = d->display,
                                   .requestor = asked->requestor,
                                   .selection = asked->selection,
                                   .target = asked->target,
                                   .property = asked->property,
                                   .time = asked->time}};
    XChangeProperty(d->display, asked->requestor, asked->property, asked->target, 8,
                    PropModeReplace, (const unsigned char *)d->uri,
                    (int)strlen(d->uri));
    XSendEvent(d->display, asked->requestor, False, NoEventMask, &event);
    XFlush(d->display);
}

/* Answer questions until this comes; what it says. */
static long wait_for(const drag *d, const char *what) {
    Atom wanted = atom(d, what);
    for (;;) {
        XEvent event;
        XNextEvent(d->display, &event);
        if (event.type == SelectionRequest) {
            answer(d, &event.xselectionrequest);
        } else if (event.type == ClientMessage &&
                   event.xclient.message_type == wanted) {
            return event.xclient.data.l[1];
        }
    }
}

static void write_uri(const char *path, char *out, size_t size) {
    size_t used = (size_t)snprintf(out, size, "file://");
    for (; *path && used + 8 < size; path++) {
        unsigned char c = (unsigned char)*path;
        used += (size_t)snprintf(out + used, size - used,
                                 isalnum(c) || strchr("/._-", c) ? "%c" : "%%%02X", c);
    }
    snprintf(out + used, size - used, "\r\n");
}

int main(int argc, char **argv) {
    drag d = {.display = XOpenDisplay(NULL)};
    if (argc != 3 || !d.display) {
        fputs("usage: drop WINDOW PATH, under X\n", stderr);
        return 2;
    }
    alarm(PATIENCE);
    d.target = strtoul(argv[1], NULL, 0);
    d.source = XCreateSimpleWindow(d.display, DefaultRootWindow(d.display), 0, 0, 1, 1,
                                   0, 0, 0);
    d.list = atom(&d, "text/uri-list");
    write_uri(argv[2], d.uri, sizeof d.uri);
    XSetSelectionOwner(d.display, atom(&d, "XdndSelection"), d.source, CurrentTime);
    tell(&d, "XdndEnter", (long)VERSION << 24, (long)d.list, 0);
    tell(&d, "XdndPosition", 0, 100L << 16 | 100, (long)atom(&d, "XdndActionCopy"));
    bool taken = wait_for(&d, "XdndStatus") & 1;
    if (taken) {
        tell(&d, "XdndDrop", 0, CurrentTime, 0);
        taken = wait_for(&d, "XdndFinished") != 0; /* GLFW: the bytes that it took */
    }
    XCloseDisplay(d.display);
    return taken ? 0 : 1;
}
