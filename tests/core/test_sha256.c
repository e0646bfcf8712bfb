// Tests for core/sha256.c

#include "core/sha256.h"

#include "tests/testlib.h"

#include <string.h>

// The examples NIST publishes with FIPS 180-4, and the empty message.
TEST(the_standards_own_messages_have_the_standards_digests)
{
    static const struct {
        const char *message, *digest;
    } example[] = {
        { "", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855" },
        { "abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad" },
        { "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1" },
        { "abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqr"
          "lmnopqrsmnopqrstnopqrstu",
          "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1" },
    };
    for (size_t i = 0; i < sizeof example / sizeof example[0]; i++) {
        char hex[65];
        dig_sha256_hex(example[i].message, strlen(example[i].message), hex);
        assert_string_equal(hex, example[i].digest);
    }
}

TEST(a_million_letters_added_piece_by_piece_have_the_standards_digest)
{
    char piece[997];
    memset(piece, 'a', sizeof piece);
    struct dig_sha256 hash;
    uint8_t           digest[32];
    dig_sha256_init(&hash);
    for (size_t left = 1000000; left > 0;) {
        const size_t size = left < sizeof piece ? left : sizeof piece;
        dig_sha256_add(&hash, piece, size);
        left -= size;
    }
    dig_sha256_finish(&hash, digest);
    static const uint8_t expected[32] = {
        0xcd, 0xc7, 0x6e, 0x5c, 0x99, 0x14, 0xfb, 0x92, 0x81, 0xa1, 0xc7,
        0xe2, 0x84, 0xd7, 0x3e, 0x67, 0xf1, 0x80, 0x9a, 0x48, 0xa4, 0x97,
        0x20, 0x0e, 0x04, 0x6d, 0x39, 0xcc, 0xc7, 0x11, 0x2c, 0xd0,
    };
    assert_memory_equal(digest, expected, sizeof expected);
}
