/* EGL without a surface; frames go into textures.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/headless.h"

#include <stdio.h>
#include <stdlib.h>

#include <epoxy/egl.h>

#include "preview/gl.h"

struct headless {
    EGLDisplay display;
    EGLContext context;
};

static EGLDisplay open_display(void) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                        EGL_DEFAULT_DISPLAY, NULL);
    }
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

/* NULL, or the step that failed. */
static const char *make_current(headless *h) {
    /* A window surface, the default of choice, does not exist here. */
    static const EGLint config_wish[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                         EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const EGLint context_wish[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                          3,
                                          EGL_CONTEXT_MINOR_VERSION_KHR,
                                          3,
                                          EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                          EGL_NONE};
    EGLConfig config;
    EGLint n = 0;
    h->display = open_display();
    if (h->display == EGL_NO_DISPLAY || !eglInitialize(h->display, NULL, NULL)) {
        return "no EGL display (is a driver installed? Debian: libgl1-mesa-dri)";
    }
    if (!eglBindAPI(EGL_OPENGL_API) ||
        !eglChooseConfig(h->display, config_wish, &config, 1, &n) || n < 1) {
        return "EGL has no desktop OpenGL";
    }
    h->context = eglCreateContext(h->display, config, EGL_NO_CONTEXT, context_wish);
    if (h->context == EGL_NO_CONTEXT) {
        return "EGL has no context of OpenGL 3.3 core";
    }
    if (!eglMakeCurrent(h->display, EGL_NO_SURFACE, EGL_NO_SURFACE, h->context)) {
        return "EGL cannot do without a surface";
    }
    return NULL;
}

headless *headless_open(pps_problem *problem) {
    headless *h = calloc(1, sizeof *h);
    if (!h) {
        snprintf(problem->text, sizeof problem->text, "out of memory");
        return NULL;
    }
    h->display = EGL_NO_DISPLAY;
    h->context = EGL_NO_CONTEXT;
    const char *why = make_current(h);
    if (why) {
        snprintf(problem->text, sizeof problem->text, "no OpenGL without a display: %s",
                 why);
    }
    if (why || !gl_good_enough(problem)) {
        headless_close(h);
        return NULL;
    }
    return h;
}

void headless_close(headless *h) {
    if (!h) {
        return;
    }
    if (h->display != EGL_NO_DISPLAY) {
        eglMakeCurrent(h->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (h->context != EGL_NO_CONTEXT) {
            eglDestroyContext(h->display, h->context);
        }
        eglTerminate(h->display);
    }
    free(h);
}
