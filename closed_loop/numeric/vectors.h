// Loops compiled once for each width of vector that a processor may have, chosen when the program
// starts. No sum changes its order and no product is fused, so all give the same bits.

#ifndef DIG_CLOSED_LOOP_NUMERIC_VECTORS_H
#define DIG_CLOSED_LOOP_NUMERIC_VECTORS_H

// A sanitizer is not ready yet when the choice is made.
#if defined __x86_64__ && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define DIG_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DIG_VECTORS
#endif

#endif // DIG_CLOSED_LOOP_NUMERIC_VECTORS_H
