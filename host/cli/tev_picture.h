// SPDX-License-Identifier: Apache-2.0
// Shows a picture in the image viewer tev while it is rendered.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/cli/command.h"
#include "host/image/tev_link.h"

namespace nearlight::core {

/// Adds --tev.
void add_tev_option(CLI::App& command, std::string& address);

class TevPicture {
  public:
    /// Connects to tev, unless `address` is empty: then nothing is sent. Throws as TevLink does.
    TevPicture(const std::string& address, std::string name);

    /// Begins with the topmost row, again if it was called before.
    void open(int width, int height);
    /// Sends the next rows, with the channels of layer_channels(). If tev is gone or no longer reads, a
    /// warning says so, and nothing is sent from then on.
    void add_rows(std::span<const float> rows);

  private:
    template <typename Action>
    void attempt(const Action& action);

    std::unique_ptr<TevLink> link_;
    std::string name_;
    std::vector<std::string> channels_;
    std::vector<float> selected_;
    int width_ = 0;
    int next_row_ = 0;
};

}  // namespace nearlight::core
