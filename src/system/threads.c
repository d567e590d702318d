#include "system/threads.h"

#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static void *wait_for_end(void *held)
{
    pthread_mutex_lock(held);
    pthread_mutex_unlock(held);
    return NULL;
}

status threads_check(int n)
{
    status st = OK;
    pthread_mutex_t held = PTHREAD_MUTEX_INITIALIZER;
    pthread_attr_t small;
    pthread_t *thread = NULL;
    int started = 0, why = 0;
    TRY(memory_alloc((size_t)n, sizeof *thread, "threads", &thread));
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, (size_t)PTHREAD_STACK_MIN + 65536);
    pthread_mutex_lock(&held);
    while (started < n && (why = pthread_create(&thread[started], &small, wait_for_end, &held)) == 0)
        started++;
    pthread_mutex_unlock(&held);
    for (int i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    pthread_attr_destroy(&small);
    if (started < n)
        st = fail(
            E_MEMORY,
            "the system allows %d more threads, and this needs %d: %s (see ulimit -u, and the pids limit of the cgroup)",
            started, n, strerror(why));
done:
    free(thread);
    return st;
}
