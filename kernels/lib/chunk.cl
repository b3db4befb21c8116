// SPDX-License-Identifier: Apache-2.0
// Splitting an array into runs, one a work-item: long ones on CPUs, short ones on GPUs. The same arithmetic
// as host/stages/chunks.h.
#ifndef NEARLIGHT_LIB_CHUNK
#define NEARLIGHT_LIB_CHUNK

/// First element of run `chunk`, and also the end of the one before; never beyond `count`.
inline uint chunk_begin(uint chunk, uint chunk_size, uint count) {
    return (uint)min((ulong)chunk * chunk_size, (ulong)count);
}

#endif
