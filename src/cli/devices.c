/* hoodoo devices: lists the devices that --device accepts. */
#include <stdio.h>
#include <stdlib.h>

#include "cli/answer.h"
#include "cli/cli.h"
#include "gpu/gpu.h"
#include "text/text.h"

static void print_text(const struct gpu_info *d, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        printf("%d  %s%s\n", d[i].index, d[i].name,
               d[i].usable ? "" : "  (not usable: needs Vulkan 1.2 with buffer addresses)");
        printf("   type    %s\n   driver  %s\n   uuid    %s\n", d[i].type, d[i].driver, d[i].uuid);
        if (d[i].pci[0])
            printf("   pci     %s\n", d[i].pci);
        printf("   memory  %.1f GB\n", (double)d[i].memory / 1e9);
    }
}

static status print_json(const struct gpu_info *d, size_t n)
{
    struct text t = {0};
    answer_begin(&t);
    json_array(&t, "devices");
    for (size_t i = 0; i < n; i++) {
        json_object(&t, NULL);
        json_integer(&t, "index", d[i].index);
        json_text(&t, "name", d[i].name);
        json_text(&t, "type", d[i].type);
        json_text(&t, "driver", d[i].driver);
        json_text(&t, "uuid", d[i].uuid);
        json_text(&t, "pci", d[i].pci);
        json_integer(&t, "memory", (int64_t)d[i].memory);
        json_bool(&t, "usable", d[i].usable);
        json_end_object(&t);
    }
    json_end_array(&t);
    json_end_object(&t);
    const status st = answer_print(&t, true);
    text_free(&t);
    return st;
}

status cli_devices(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct gpu_info *devices = NULL;
    size_t n;
    bool help = false;
    const struct option options[] = {OPTION_JSON(&c)};
    TRY(options_parse(&usage_devices, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    TRY(gpu_list(&devices, &n));
    if (c.json)
        TRY(print_json(devices, n));
    else
        print_text(devices, n);
done:
    free(devices);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
