#include "look/print.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/path.h"
#include "render/picture.h"
#include "render/png.h"
#include "system/atomic_file.h"
#include "system/child.h"

/* Temporary files, whose names contain no characters that are special to oiiotool. */
struct drawn {
    struct path folder, picture, bar, png, log;
};

static status name_files(const char *folder, struct drawn *d)
{
    status st = OK;
    TRY(path_format(&d->folder, "%s", folder));
    TRY(atomic_file_temporary("look", ".ppm", &d->picture));
    TRY(atomic_file_temporary("look", ".ppm", &d->bar));
    TRY(atomic_file_temporary("look", "", &d->png));
    TRY(atomic_file_temporary("look", "", &d->log));
done:
    return st;
}

static status write_in(const struct drawn *d, const struct path *name, const void *bytes, size_t n)
{
    status st = OK;
    struct path full;
    TRY(path_join(&full, d->folder.text, name->text));
    TRY(atomic_file_write(full.text, bytes, n));
done:
    return st;
}

static void remove_files(const struct drawn *d)
{
    const struct path *all[] = {&d->picture, &d->bar, &d->png, &d->log};
    struct path full;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (*all[i]->text && path_join(&full, d->folder.text, all[i]->text) == OK)
            unlink(full.text);
}

static status draw(const struct shot *shot, const struct slate *slate, const struct drawn *d)
{
    status st = OK;
    struct slate_command command;
    struct children children;
    struct path bar;
    children_begin(&children, d->folder.text, d->log.text, PICTURE_PACKAGES, 1);
    TRY(write_in(d, &d->picture, shot->ppm, shot->size));
    if (slate->show != VALUE_NONE) {
        TRY(path_join(&bar, d->folder.text, d->bar.text));
        TRY(slate_write_bar(slate, bar.text));
    }
    slate_command(slate, d->picture.text, d->bar.text, d->png.text, &command);
    TRY(children_run(&children, command.argv, "the picture's strip", NULL, NULL));
    TRY(children_wait(&children));
done:
    children_end(&children);
    return st;
}

status print_picture(const struct shot *shot, const struct slate *slate, const char *folder, void **out,
                     size_t *n)
{
    status st = OK;
    struct drawn d = {0};
    struct path full;
    void *bytes = NULL;
    *out = NULL;
    if (!slate_draws(slate))
        return png_encode(shot->rgb, shot->camera.width, shot->camera.height, out, n);
    TRY(name_files(folder, &d));
    TRY(draw(shot, slate, &d));
    TRY(path_join(&full, d.folder.text, d.png.text));
    TRY(file_read(full.text, (size_t)1 << 30, &bytes, n));
    TRY(png_with_tag(bytes, *n, "look", out, n));
done:
    remove_files(&d);
    free(bytes);
    return st;
}
