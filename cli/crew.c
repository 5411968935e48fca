/* The same work on several threads.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "crew.h"

#include <pthread.h>
#include <stdlib.h>

void crew_run(int n, void *(*work)(void *context), void *context) {
    pthread_t *thread = n > 1 ? calloc((size_t)n - 1, sizeof *thread) : NULL;
    int started = 0;

    while (thread && started < n - 1 &&
           pthread_create(&thread[started], NULL, work, context) == 0)
        started++;
    work(context);
    for (int i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    free(thread);
}
