#include "core/sha256.h"

#include <assert.h>

void dig_sha256_init(struct dig_sha256 *const hash)
{
    assert(hash != NULL);
    sha256_init(&hash->context);
}

void dig_sha256_add(struct dig_sha256 *const hash, const void *const data, const size_t size)
{
    assert(hash != NULL && (data != NULL || size == 0));
    sha256_update(&hash->context, size, data);
}

void dig_sha256_finish(struct dig_sha256 *const hash, uint8_t digest[const 32])
{
    assert(hash != NULL && digest != NULL);
    sha256_digest(&hash->context, 32, digest);
}

uint64_t dig_sha256_finish_number(struct dig_sha256 *const hash)
{
    uint8_t  digest[32];
    uint64_t bits = 0;
    dig_sha256_finish(hash, digest);
    for (size_t i = 0; i < 8; i++) {
        bits = bits << 8 | digest[i];
    }
    return bits >> 1;
}

void dig_sha256_hex(const void *const data, const size_t size, char hex[const 65])
{
    static const char digits[] = "0123456789abcdef";
    struct dig_sha256 hash;
    uint8_t           digest[32];
    dig_sha256_init(&hash);
    dig_sha256_add(&hash, data, size);
    dig_sha256_finish(&hash, digest);
    for (size_t i = 0; i < 32; i++) {
        hex[2 * i]     = digits[digest[i] >> 4];
        hex[2 * i + 1] = digits[digest[i] & 15];
    }
    hex[64] = '\0';
}
