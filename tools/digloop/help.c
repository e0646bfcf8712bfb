#include "tools/digloop/commands.h"

#include "tools/help.h"

#include <stdio.h>
#include <string.h>

static const struct dig_help commands[] = {
    { "identify",
      "  digloop identify TABLE.sqlite RECORDING… [--machine MACHINE.yaml] [--model MODEL.json]\n"
      "                   [--trajectory NAME] [--moment-alone] [--json]\n",
      "      which gravel: all digs of the recordings matched together, by moment and forces "
      "where\n"
      "      every dig has them, else by the moment alone, as --moment-alone does in any case. A\n"
      "      recording is a force recording, or with --machine a machine recording or an LCM log\n"
      "      of the daemon, which may hold several digs. They are to be along one trajectory, or\n"
      "      along such as begin with \"simple\"; --trajectory takes those along one.\n"
      "      --model: table and machine with the effects that a trace has added\n",
      "  digloop identify tables/rig.sqlite simpleA_1.csv simpleA_2.csv --json >id.json\n"
      "  digloop identify tables/rig.sqlite run.csv --machine config/machines/zx200_trench.yaml\n"
      "  digloop identify tables/rig.sqlite day.lcm --machine config/machines/zx200_trench.yaml "
      "\\\n"
      "          --trajectory simpleA --json >id.json\n" },
    { "predict",
      "  digloop predict TABLE.sqlite --identified ID.json --trajectory NAME\n"
      "                  [--depth F] [--attack-deg A] [-o CURVE.csv]\n"
      "                  [--measured RECORDING [--machine MACHINE.yaml]] [--model MODEL.json]\n"
      "                  [--json]\n",
      "      what that gravel will resist along another trajectory, at the table's scale, dug\n"
      "      deeper or with the bucket turned where the table was; with digs measured, how wrong\n"
      "      that was, each as it was dug: relative Euclidean norm of the moment, +-0.16 s.\n"
      "      --model: table and machine with the effects that a trace has added\n",
      "  digloop predict tables/rig.sqlite --identified id.json --trajectory actual \\\n"
      "          --measured actual_1.csv\n"
      "  digloop predict tables/rig.sqlite --identified id.json --trajectory actual \\\n"
      "          --measured day.lcm --machine config/machines/zx200_trench.yaml\n" },
    { "trace",
      "  digloop trace TABLE.sqlite CAMPAIGN/ [--effects EFFECTS.sqlite]\n"
      "                [--json OUT.json] [--html OUT.html] [--add MODEL.json]\n",
      "      what the table lacks: the residual of a campaign's digs, the effect it traces to, "
      "the\n"
      "      error on the holdout digs before and after that effect is added. Effects of the soil\n"
      "      are compared with beds that hold them, by default those of TABLE_effects.sqlite. OUT\n"
      "      or MODEL \"-\": standard output. What people are told goes there without --json and\n"
      "      --add, else to standard error\n",
      "  digloop trace tables/rig.sqlite campaign/\n"
      "  digloop trace tables/rig.sqlite campaign/ --json trace.json --html trace.html \\\n"
      "          --add model.json\n" },
    { "design", "  digloop design TABLE.sqlite [--effects EFFECTS.sqlite] [--json]\n",
      "      which simple dig of the table tells most about the gravel and tells effects apart,\n"
      "      and whether digs simulated with the table's own scatter bear that out\n",
      "  digloop design tables/rig.sqlite\n" },
};

#define COMMANDS (sizeof commands / sizeof commands[0])

bool digloop_is_command(const char *const name)
{
    for (size_t i = 0; i < COMMANDS; i++) {
        if (strcmp(commands[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

void digloop_help(const char *const command)
{
    const struct dig_help_of_program program = {
        .intro      = "digloop finds the gravel of a table that resists like recorded digs, "
                      "predicts other digs,\nand traces what a model lacks.\n\n",
        .others     = "  digloop --help | --version, digloop COMMAND --help\n",
        .exit_codes = "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n",
        .commands   = COMMANDS,
        .command    = commands,
    };
    dig_help_print(&program, command, stdout);
}
