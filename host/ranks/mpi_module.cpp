// SPDX-License-Identifier: Apache-2.0
// The module that calls MPI.
#include <mpi.h>

#include <array>

#include "host/ranks/mpi_functions.h"

namespace nearlight::core {
namespace {

std::string text_of(int error) {
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(error, text.data(), &length);
    return {text.data(), static_cast<std::size_t>(length)};
}

/// Errors are returned, because a rank that died is no reason to end the others.
std::string start(int& rank, int& count, std::string& host) {
    int level = 0;
    if (const int error = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
        error != MPI_SUCCESS) {
        return text_of(error);
    }
    if (level < MPI_THREAD_FUNNELED) {
        return "it does not allow programs with threads";
    }
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
    int length = 0;
    MPI_Get_processor_name(name.data(), &length);
    host.assign(name.data(), static_cast<std::size_t>(length));
    return {};
}

/// A message under way, or one that MPI did not take.
struct Transfer {
    MPI_Request request = MPI_REQUEST_NULL;
    bool is_lost = false;
};

void* begin_send(int to, std::span<const std::byte> bytes) {
    MPI_Request request = MPI_REQUEST_NULL;
    if (MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD, &request) !=
        MPI_SUCCESS) {
        return nullptr;
    }
    return new Transfer{.request = request};
}

/// MPI_Recv would wait for ever for the rest of a message whose sender died after its head was here.
void* begin_receive(int& from, std::vector<std::byte>& bytes) {
    int found = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status{};
    if (MPI_Improbe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &found, &message, &status) != MPI_SUCCESS ||
        found == 0) {
        return nullptr;
    }
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    bytes.resize(static_cast<std::size_t>(size));
    from = status.MPI_SOURCE;
    MPI_Request request = MPI_REQUEST_NULL;
    // MPI_Improbe has taken the message already, so nobody else can receive it.
    const bool is_lost = MPI_Imrecv(bytes.data(), size, MPI_BYTE, &message, &request) != MPI_SUCCESS;
    return new Transfer{.request = request, .is_lost = is_lost};
}

TransferState state_of(void* transfer) {
    auto* const message = static_cast<Transfer*>(transfer);
    int done = 0;
    const bool failed =
        message->is_lost || MPI_Test(&message->request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS;
    if (!failed && done == 0) {
        return TransferState::under_way;
    }
    delete message;
    return failed ? TransferState::failed : TransferState::done;
}

void finish(bool with_others) {
    if (with_others) {
        MPI_Finalize();
    }
}

}  // namespace
}  // namespace nearlight::core

extern "C" __attribute__((visibility("default"))) const nearlight::core::MpiFunctions nearlight_mpi_functions{
    nearlight::core::start, nearlight::core::begin_send, nearlight::core::begin_receive,
    nearlight::core::state_of, nearlight::core::finish};
