// Tests for tables/schema/seal.c: nothing of a table changes in silence.

#include "tests/table_content.h"
#include "tests/tables_fixture.h"

#include "tables/merge.h"

static void make_sealed(const char *const name)
{
    struct dig_store *const store = fixture_create(name);
    fixture_put(store, .3, .3, 0, 0, 1.0);
    fixture_put(store, .3, .3, 1, 0, 2.0);
    fixture_put(store, .3, .3, 0, 1, 2.5);
    fixture_put(store, .5, .3, 0, 1, 3.0);
    fixture_put_run(store, fixture_varied(fixture_origin(.5, .3, 2500, 0, 0), "cohesion", 2e5), 4);
    dig_store_close(store);
}

static enum dig_status try_load(const char *const path, struct dig_error *const error)
{
    struct dig_curve_set *set     = NULL;
    struct dig_entry_set *effects = NULL;
    const enum dig_status status  = dig_table_list(path, &set, &effects, error);
    dig_curve_set_destroy(set);
    dig_entry_set_destroy(effects);
    return status;
}

TEST_WITH(every_column_of_a_run_and_of_an_entry_counts, scratch_setup, scratch_teardown)
{
    make_sealed("good.sqlite");
    assert_int_equal(try_load(scratch_path("good.sqlite"), NULL), DIG_OK);
    static const char *const changes[] = {
        "UPDATE run SET seed = seed + 1 WHERE id = 1",
        "UPDATE run SET engine = 'tesu' WHERE id = 2",
        "UPDATE run SET version = '1.3' WHERE id = 5",
        "UPDATE run SET grains = 13 WHERE id = 1",
        "UPDATE run SET first_s = first_s + 1e-9 WHERE id = 1",
        "UPDATE run SET step_s = step_s * (1 + 1e-12) WHERE id = 1",
        "UPDATE run SET made_utc = '2026-01-01T00:00:01Z' WHERE id = 1",
        "UPDATE run SET wall_s = 0.25 WHERE id = 4",
        "UPDATE run SET packing = 7 WHERE id = 4",
        "UPDATE run SET windows = windows / 2, curve = CAST(substr(curve, 1, length(curve) / 2) "
        "AS BLOB) WHERE id = 1",
        "UPDATE run SET curve = CAST(x'01' || substr(curve, 2) AS BLOB) WHERE id = 4",
        "UPDATE entry SET mean = CAST(x'01' || substr(mean, 2) AS BLOB) WHERE rowid = 4",
        "UPDATE entry SET spread = CAST(x'01' || substr(spread, 2) AS BLOB) WHERE packings = 2",
        "UPDATE entry SET packings = 3 WHERE packings = 2",
        "UPDATE ground SET friction = 0.31 WHERE id = 1",
        "UPDATE ground SET magnitude = 1e5 WHERE effect <> ''",
        "UPDATE ground SET depth = 1.1 WHERE id = 1",
        "UPDATE ground SET attack_rad = 0.1 WHERE id = 1",
        "UPDATE scene SET tooth_m = tooth_m * 1.01",
        "UPDATE scene SET bucket_width_m = bucket_width_m * 1.01",
        "UPDATE scene SET young_Pa = young_Pa * 1.01",
        "UPDATE scene SET smooth_half_s = 0.17",
        "UPDATE scene SET name = 'tuc'",
        "UPDATE seal SET sum = sum + 1 WHERE rowid = 1",
        "DELETE FROM seal WHERE rowid = 2",
        "DELETE FROM run WHERE id = 1",
        "DELETE FROM seal WHERE rowid = 1; DELETE FROM entry WHERE rowid = 1",
        "UPDATE entry SET trajectory = 0 WHERE rowid = 4; UPDATE run SET trajectory = 0 WHERE id = "
        "4; UPDATE seal SET trajectory = 0 WHERE rowid = 4",
    };
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        struct dig_error  error = { "" };
        const char *const path  = fixture_copy("good.sqlite", "bad.sqlite", changes[i]);
        if (try_load(path, &error) != DIG_EINVAL) {
            fail_msg("taken: %s", changes[i]);
        }
        assert_contains(error.text, "bad.sqlite: damaged: ");
    }
}

// One bit of each byte of the header, and anywhere in the file: in pages of tables and indexes,
// between rows.
TEST_WITH(a_flipped_bit_is_found_or_changes_nothing, scratch_setup, scratch_teardown)
{
    enum { HEADER = 100 };
    make_sealed("good.sqlite");
    uint64_t before = 0;
    assert_true(table_content(scratch_path("good.sqlite"), &before));
    size_t      size    = 0;
    char *const whole   = scratch_read(scratch_path("good.sqlite"), &size);
    size_t      refused = 0, as_before = 0;
    uint64_t    random = 88172645463325252U;
    const int   flips  = test_is_quick() ? 200 : 600;
    for (int i = 0; i < flips; i++) {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        const size_t at   = i < HEADER ? (size_t)i : (size_t)(random >> 3) % size;
        const char   kept = whole[at];
        uint64_t     sum  = 0;
        whole[at]         = (char)(kept ^ (1 << (random & 7)));
        if (!table_content(scratch_write_bytes("flip.sqlite", whole, size), &sum)) {
            refused++;
        } else if (sum == before) {
            as_before++;
        } else {
            fail_msg("bit %u of byte %zu: other curves in silence", (unsigned)(random & 7), at);
        }
        whole[at] = kept;
    }
    free(whole);
    assert_true(refused > 0 && as_before > 0); // rows, and what is free between them
}

TEST_WITH(a_merged_table_has_the_seals_of_its_inputs, scratch_setup, scratch_teardown)
{
    make_sealed("good.sqlite");
    char out[512];
    (void)snprintf(out, sizeof out, "%s", scratch_path("merged.sqlite"));
    const char *const input[] = { scratch_path("good.sqlite") };
    struct dig_error  error   = { "" };
    assert_ok(dig_store_merge(out, 1, input, &error), error);
    assert_int_equal(try_load(out, NULL), DIG_OK);
    assert_true(fixture_ask("merged.sqlite", "SELECT sum(sum / 16) FROM seal") ==
                fixture_ask("good.sqlite", "SELECT sum(sum / 16) FROM seal"));
}
