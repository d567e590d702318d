#include "farm/opencue.h"

/* PyOutline executes the script within a function, where inner scopes do not see its names: no functions, no comprehensions. Commands are
 * lists of arguments, which PyOutline executes without a shell. */
static const char body[] =
    "import json\n"
    "\n"
    "from outline.modules.shell import ShellSequence\n"
    "\n"
    "with open(TASKS, encoding='utf-8') as file:\n"
    "    tasks = json.load(file)['tasks']\n"
    "groups = {}\n"
    "for task in tasks:\n"
    "    if task['after_any'] and not END:\n"
    "        continue\n"
    "    kind = task['name'].rsplit('.', 1)[0]\n"
    "    groups.setdefault((kind, tuple(task['after'])), []).append(task)\n"
    "layers = {}\n"
    "for (kind, after), group in groups.items():\n"
    "    first = group[0]\n"
    "    commands = []\n"
    "    for task in group:\n"
    "        commands.append(task['argv'])\n"
    "    more = {}\n"
    "    if first['gpu']:\n"
    "        more['gpus'] = 1\n"
    "        more['gpu_memory'] = '%dm' % -(-first['gpu_memory_bytes'] // 2**20)\n"
    "    if first['time_limit_seconds']:\n"
    "        more['timeout'] = -(-first['time_limit_seconds'] // 60)\n"
    "    layer = ShellSequence(first['name'].replace('.', '_'), commands=commands, cores=first['cpus'], threadable=True,\n"
    "                          memory='%dm' % -(-first['memory_bytes'] // 2**20), **more)\n"
    "    for name, value in first['environment'].items():\n"
    "        layer.set_env(name, value)\n"
    "    for name in after:\n"
    "        layer.depend_all(layers[name])\n"
    "    for task in group:\n"
    "        layers[task['name']] = layer\n";

status opencue_outline(const struct farm *f, const char *tasks, struct text *t)
{
    text_add(t,
             "# Written by hoodoo; submit it with pycuerun. Its paths are those of this machine.\nTASKS =");
    json_text(t, NULL, tasks); /* a string of JSON is one of Python */
    /* OpenCue runs a layer only when all that it waits for succeeded or was given up (eaten). */
    text_add(t, "\nEND = %s\n%s", f->base->farm.n_on_done ? "True" : "False", body);
    return text_status(t);
}
