// SHA-256 (FIPS 180-4), for the identity of scenes and beds and for the seals of tables: nettle's,
// which uses the processor's own instructions. Not meant for secrets.

#ifndef DIG_CORE_SHA256_H
#define DIG_CORE_SHA256_H

#include <nettle/sha2.h>
#include <stddef.h>
#include <stdint.h>

struct dig_sha256 {
    struct sha256_ctx context;
};

void dig_sha256_init(struct dig_sha256 *hash);
void dig_sha256_add(struct dig_sha256 *hash, const void *data, size_t size);
void dig_sha256_finish(struct dig_sha256 *hash, uint8_t digest[32]);

/// Finishes with the first 63 bits of the digest alone.
uint64_t dig_sha256_finish_number(struct dig_sha256 *hash);

/// The digest of one buffer as 64 lower-case hex digits and a NUL.
void dig_sha256_hex(const void *data, size_t size, char hex[65]);

#endif // DIG_CORE_SHA256_H
