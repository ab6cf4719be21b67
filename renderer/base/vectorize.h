/// Loops over lanes that the compiler turns into vector code.
#pragma once

/// Before a function: it is compiled for AVX2 as well, and the program takes that where the processor has it.
/// Both give the same bits: AVX2 alone has no fused multiply-add. Sanitizers do not stand the choice at
/// start-up.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PARIAN_VECTORIZE __attribute__((target_clones("avx2", "default")))
#else
#define PARIAN_VECTORIZE
#endif
