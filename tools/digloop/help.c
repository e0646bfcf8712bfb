#include "tools/digloop/help.h"

static const struct dig_command commands[] = {
    { "identify", "TABLE.sqlite RECORDING... [OPTION]...",
      "Finds the gravel that resists like recorded digs.",
      "All digs are matched together, by moment and forces where every dig has them, else by the "
      "moment alone. They are to be along one trajectory, or along such as begin with "
      "\"simple\".\n\n"
      "A recording is a force recording, or with --machine a machine recording or an LCM log of "
      "the daemon, which may hold several digs.",
      "digloop identify tables/product.sqlite simple1.csv simple2.csv --json >id.json\n"
      "digloop identify tables/product.sqlite run.csv \\\n"
      "        --machine config/machines/zx200_trench.yaml\n"
      "digloop identify tables/product.sqlite day.lcm --trajectory simpleA \\\n"
      "        --machine config/machines/zx200_trench.yaml --json >id.json\n" },
    { "predict", "TABLE --identified ID --trajectory NAME [OPTION]...",
      "Predicts what an identified gravel resists other digs with.",
      "At the table's scale, with --machine at that machine's, too: its forces are lambda^3, its "
      "moments lambda^4 times the table's, lambda being how many times its bucket is as long. Dug "
      "deeper or with the bucket turned where the table was. With digs measured, how wrong that "
      "was, each as it was dug: relative Euclidean norm of the moment, "
      "+-0.16 s.",
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --machine config/machines/zx200_trench.yaml\n"
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --measured actual_1.csv\n"
      "digloop predict tables/product.sqlite --identified id.json \\\n"
      "        --trajectory actual --measured day.lcm \\\n"
      "        --machine config/machines/zx200_trench.yaml\n" },
    { "trace", "TABLE.sqlite CAMPAIGN/ [OPTION]...", "Traces what the table lacks to an effect.",
      "The residual of a campaign's digs, the effect it traces to, the error on the holdout digs "
      "before and after that effect is added. Effects of the soil are compared with beds that hold "
      "them.\n\n"
      "A file \"-\" is standard output. What people are told goes there without --json and --add, "
      "else to standard error.",
      "digloop trace tables/product.sqlite campaign/\n"
      "digloop trace tables/product.sqlite campaign/ --html trace.html \\\n"
      "        --json trace.json --add model.json\n" },
    { "check", "MACHINE.yaml RECORDING [OPTION]...",
      "Says what a machine file makes of a recording in free air.",
      "A checklist: sample times, stuck sensors, how far each joint moves, which way and from "
      "where "
      "angles count, which cylinder is which, head and rod, units, offsets, weights, delay, and "
      "what "
      "none of that explains. Each answer with its 1 sigma, what is allowed, and what to do.\n\n"
      "RECORDING is a machine recording or an LCM log of the daemon, in which the bucket touches "
      "nothing: move boom, arm and bucket one after the other through most of their range, slowly, "
      "for about a minute. `digrig air` makes one of a simulated machine.\n\n"
      "A file \"-\" is standard output. The exit status is 2 where something is wrong.",
      "digloop check config/machines/zx120.yaml air.csv\n"
      "digloop check my.yaml air.lcm --html check.html --json check.json\n" },
    { "design", "TABLE.sqlite [OPTION]...",
      "Tells which simple dig of the table tells most about the gravel.",
      "And which tells effects apart, and whether digs simulated with the table's own scatter bear "
      "that out.",
      "digloop design tables/product.sqlite\n" },
};

static const struct dig_option options[] = {
    { "identified", DIGLOOP_IDENTIFIED, "ID.json", " predict ",
      "the gravel, as `digloop identify --json` wrote it" },
    { "trajectory", DIGLOOP_TRAJECTORY, "NAME", " identify ", "take the digs along one only" },
    { "trajectory", DIGLOOP_TRAJECTORY, "NAME", " predict ", "the dig to predict" },
    { "machine", DIGLOOP_MACHINE, "MACHINE.yaml", " identify ",
      "the recordings are of this machine" },
    { "machine", DIGLOOP_MACHINE, "MACHINE.yaml", " predict ",
      "the measured digs are of this machine; peak and energy by it, too" },
    { "model", DIGLOOP_MODEL, "MODEL.json", " identify predict ",
      "table and machine with the effects that a trace has added" },
    { "moment-alone", DIGLOOP_MOMENT_ALONE, NULL, " identify ", "leave the forces out" },
    { "measured", DIGLOOP_MEASURED, "RECORDING", " predict ", "compare with digs measured" },
    { "depth", DIGLOOP_DEPTH, "F", " predict ",
      "factor on how far the tooth goes down in the first phase, 0.2 to 3 (default 1)" },
    { "attack-deg", DIGLOOP_ATTACK, "A", " predict ",
      "the bucket turned about its tooth, -45 to 45, positive curls (default 0)" },
    { "output", DIGLOOP_OUTPUT, "CURVE.csv", " predict ", "also write the predicted curve" },
    { "effects", DIGLOOP_EFFECTS, "EFFECTS.sqlite", " trace design ",
      "beds that hold effects of the soil (default: TABLE_effects.sqlite beside the table)" },
    { "json", DIGLOOP_JSON, NULL, " identify predict design ",
      "the result as JSON on standard output" },
    { "json", DIGLOOP_JSON, "OUT.json", " trace check ", "write the result as JSON" },
    { "html", DIGLOOP_HTML, "OUT.html", " trace check ", "write it as a page with plots" },
    { "add", DIGLOOP_ADD, "MODEL.json", " trace ",
      "write the model with the effect added, for digsightd and --model" },
    { "quiet", DIGLOOP_QUIET, NULL, " trace check ", "nothing for people, only what goes wrong" },
};

const struct dig_program *digloop_program(void)
{
    static const struct dig_program program = {
        .self        = { "digloop",
                         "COMMAND TABLE.sqlite ARGUMENT... [OPTION]...\ncheck MACHINE.yaml RECORDING "
                                "[OPTION]...\nCOMMAND --help",
                         "Finds the gravel of a table that resists like recorded digs, predicts other "
                                "digs, and traces what a model lacks.",
                         NULL,
                         "digloop identify tables/product.sqlite simpleA_1.csv --json >id.json\n"
                                "digloop predict tables/product.sqlite --identified id.json --trajectory "
                                "actual\n" },
        .exit_status = "0  done\n1  the work failed\n2  bad usage or bad input, or a check that "
                       "finds something wrong\n",
        .commands    = sizeof commands / sizeof commands[0],
        .command     = commands,
        .options     = sizeof options / sizeof options[0],
        .option      = options,
    };
    return &program;
}
