// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nearlight::core {

/// Opens standard input, output and error where the parent closed them, so that no other file gets their
/// numbers. Writes to a pipe whose reader is gone, or beyond a limit of file sizes, then fail instead of
/// ending the process: a picture must not be lost with its progress bar. Call it first of all.
void prepare_standard_streams();

}  // namespace nearlight::core
