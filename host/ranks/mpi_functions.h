// SPDX-License-Identifier: Apache-2.0
// What nearlight needs of MPI. The functions are in a module, so that the program starts without the
// libraries of MPI, and runs where there are none.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace nearlight::core {

enum class TransferState {
    under_way,
    done,
    failed,  ///< it will never be whole
};

/// Only one thread may call the functions, and each process can start MPI once.
struct MpiFunctions {
    /// Joins the job that the launcher started. Returns why that failed, or an empty text.
    std::string (*start)(int& rank, int& count, std::string& host);
    /// Begins to send `bytes`, which must stay as they are until they are sent. A null pointer if that
    /// failed.
    void* (*begin_send)(int to, std::span<const std::byte> bytes);
    /// Begins to receive the next message if one is on its way, and gives `bytes` its size. They must stay
    /// where they are until it is here. A null pointer if there is none.
    void* (*begin_receive)(int& from, std::vector<std::byte>& bytes);
    /// How far a message is. Once it is no longer under way, `transfer` is no longer valid.
    TransferState (*state_of)(void* transfer);
    /// Leaves the job. Waits for the other ranks to do so, if `with_others` is set.
    void (*finish)(bool with_others);
};

/// The module and its only symbol, a `const MpiFunctions`.
inline constexpr const char* kMpiModule = "nearlight-mpi.so";
inline constexpr const char* kMpiFunctionsName = "nearlight_mpi_functions";

}  // namespace nearlight::core
