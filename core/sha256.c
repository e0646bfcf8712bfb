#include "core/sha256.h"

#include <assert.h>
#include <string.h>

// FIPS 180-4, 4.2.2: the first 32 bits of the fractional parts of the cube roots of the first 64
// primes.
static const uint32_t constant[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2,
};

static uint32_t rotate(const uint32_t x, const unsigned bits)
{
    return (x >> bits) | (x << (32U - bits));
}

static uint32_t big_endian(const uint8_t b[const 4])
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

// 6.2.2: step u of eight. Working variable i of step u is v[(i - u) mod 8], so that none is moved.
static inline void take_step(uint32_t v[const 8], const size_t u, const uint32_t input)
{
    const uint32_t a      = v[(8 - u) % 8];
    const uint32_t b      = v[(9 - u) % 8];
    const uint32_t c      = v[(10 - u) % 8];
    const uint32_t e      = v[(12 - u) % 8];
    const uint32_t f      = v[(13 - u) % 8];
    const uint32_t g      = v[(14 - u) % 8];
    const uint32_t sum1   = rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25);
    const uint32_t choose = (e & f) ^ (~e & g);
    const uint32_t t1     = v[(15 - u) % 8] + sum1 + choose + input;
    const uint32_t sum0   = rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22);
    const uint32_t major  = (a & b) ^ (a & c) ^ (b & c);
    v[(11 - u) % 8] += t1;
    v[(15 - u) % 8] = t1 + sum0 + major;
}

// 6.2.2: one block of the message.
static void digest_block(uint32_t state[const 8], const uint8_t block[const 64])
{
    uint32_t w[64];
    for (size_t t = 0; t < 16; t++) {
        w[t] = big_endian(block + 4 * t);
    }
    for (size_t t = 16; t < 64; t++) {
        const uint32_t s0 = rotate(w[t - 15], 7) ^ rotate(w[t - 15], 18) ^ (w[t - 15] >> 3);
        const uint32_t s1 = rotate(w[t - 2], 17) ^ rotate(w[t - 2], 19) ^ (w[t - 2] >> 10);
        w[t]              = w[t - 16] + s0 + w[t - 7] + s1;
    }

    uint32_t v[8];
    memcpy(v, state, sizeof v);
    for (size_t t = 0; t < 64; t += 8) {
#pragma GCC unroll 8
        for (size_t u = 0; u < 8; u++) {
            take_step(v, u, constant[t + u] + w[t + u]);
        }
    }
    for (size_t i = 0; i < 8; i++) {
        state[i] += v[i];
    }
}

void dig_sha256_init(struct dig_sha256 *const hash)
{
    *hash = (struct dig_sha256){
        .state = { 0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c,
                   0x1f83d9ab, 0x5be0cd19 },
    };
}

void dig_sha256_add(struct dig_sha256 *const hash, const void *const data, const size_t size)
{
    assert(hash != NULL && (data != NULL || size == 0));
    const uint8_t *byte = data;
    for (size_t left = size; left > 0;) {
        const size_t filled = hash->bytes % 64;
        const size_t taken  = left < 64 - filled ? left : 64 - filled;
        memcpy(hash->block + filled, byte, taken);
        hash->bytes += taken;
        byte += taken;
        left -= taken;
        if (hash->bytes % 64 == 0) {
            digest_block(hash->state, hash->block);
        }
    }
}

void dig_sha256_finish(struct dig_sha256 *const hash, uint8_t digest[const 32])
{
    // 5.1.1: a one bit, zeros, and the length in bits as the last eight bytes of a block.
    const uint64_t bits = hash->bytes * 8;
    const uint8_t  one  = 0x80;
    const uint8_t  zero = 0;
    dig_sha256_add(hash, &one, 1);
    while (hash->bytes % 64 != 56) {
        dig_sha256_add(hash, &zero, 1);
    }
    for (unsigned shift = 64; shift > 0; shift -= 8) {
        const uint8_t byte = (uint8_t)(bits >> (shift - 8));
        dig_sha256_add(hash, &byte, 1);
    }
    for (size_t i = 0; i < 32; i++) {
        digest[i] = (uint8_t)(hash->state[i / 4] >> (24 - 8 * (i % 4)));
    }
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
