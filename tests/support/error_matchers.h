// SPDX-License-Identifier: Apache-2.0
// Makes the Error that an action throws available to tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "nearlight/error.h"

namespace nearlight::core::test {

/// The Error that `action` throws; fails the test (and returns ErrorKind::failure) if it throws none.
template <typename Action>
Error error_of(Action&& action) {
    try {
        std::forward<Action>(action)();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was thrown";
    return {ErrorKind::failure, ""};
}

inline ::testing::AssertionResult mentions(const Error& error, const std::string& text) {
    if (std::string(error.what()).find(text) != std::string::npos) {
        return ::testing::AssertionSuccess();
    }
    return ::testing::AssertionFailure() << "'" << text << "' is not in: " << error.what();
}

}  // namespace nearlight::core::test
