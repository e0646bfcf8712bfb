// Tests for files/job_plan.c

#include "files/job_plan.h"

#include "tests/scratch.h"

static const char good[] = "job: digtable-0123456789ab\n"
                           "digs_sha256: "
                           "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef\n"
                           "engine: kernel\n"
                           "version: 0.1.0+0123456789ab\n"
                           "tasks: 5\n"
                           "beds: 12\n"
                           "trajectories: 3\n";

TEST(what_is_written_is_read_back)
{
    struct dig_job_plan plan;
    struct dig_job_plan back;
    struct dig_error    error = { "" };
    assert_ok(dig_job_plan_read(scratch_write("good.yaml", good), &plan, &error), error);
    assert_string_equal(plan.job, "digtable-0123456789ab");
    assert_int_equal(plan.tasks, 5);
    assert_int_equal(plan.beds, 12);
    assert_int_equal(plan.trajectories, 3);
    assert_int_equal(dig_job_plan_write(scratch_path("back.yaml"), &plan, NULL), DIG_OK);
    assert_int_equal(dig_job_plan_read(scratch_path("back.yaml"), &back, NULL), DIG_OK);
    assert_memory_equal(&plan, &back, sizeof plan);
    assert_false(scratch_exists("back.yaml.part"));
}

TEST(the_example_is_read)
{
    struct dig_job_plan plan;
    struct dig_error    error = { "" };
    assert_ok(dig_job_plan_read("tests/data/formats/plan.yaml", &plan, &error), error);
    assert_int_equal(plan.tasks, 3);
}

// 12 beds in 5 shards: 3, 3, 2, 2, 2, as tables/queue.h deals them out.
TEST(the_digs_of_all_shards_are_those_of_the_plan)
{
    const struct dig_job_plan plan     = { .tasks = 5, .beds = 12, .trajectories = 3 };
    static const size_t       wanted[] = { 9, 9, 6, 6, 6 };
    for (size_t task = 1; task <= plan.tasks; task++) {
        assert_int_equal(dig_job_plan_digs(&plan, task), wanted[task - 1]);
    }
}

TEST(what_cannot_be_is_refused_by_key)
{
    static const struct {
        const char *line, *instead, *says;
    } cases[] = {
        { "job: digtable-0123456789ab", "job: \"a b\"", ":1: job: \"a b\"" },
        { "job: digtable-0123456789ab", "job: --all", ":1: job: \"--all\"" },
        { "digs_sha256: 0123456789abcdef", "digs_sha256: 0123456789abcdeff", ":2: digs_sha256" },
        { "tasks: 5", "tasks: 0", ":5: tasks: 0, expected 1 … 10000" },
        { "tasks: 5", "tasks: 10001", ":5: tasks: 10001" },
        { "beds: 12", "beds: 4", ":6: beds: 4, expected 5" },
        { "beds: 12", "beds: 10000001", ":6: beds" },
        { "trajectories: 3", "trajectories: 0", ":7: trajectories: 0" },
        { "trajectories: 3", "trajectories: 9", ":7: trajectories: 9" },
        { "engine: kernel\n", "", "engine" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char                      text[1000];
        const char *const         at        = strstr(good, cases[i].line);
        struct dig_job_plan       plan      = { .tasks = 77 };
        const struct dig_job_plan as_before = plan;
        struct dig_error          error     = { "" };
        assert_non_null(at);
        (void)snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, cases[i].instead,
                       at + strlen(cases[i].line));
        assert_refused(dig_job_plan_read(scratch_write("bad.yaml", text), &plan, &error), error,
                       DIG_EINVAL, cases[i].says);
        assert_memory_equal(&plan, &as_before, sizeof plan);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
