// SPDX-License-Identifier: Apache-2.0
#include "host/cli/tev_picture.h"

#include <utility>

#include "host/cli/log.h"
#include "host/stages/film_layers.h"
#include "nearlight/error.h"

namespace nearlight::core {

void add_tev_option(CLI::App& command, std::string& address) {
    command
        .add_option(
            "--tev", address,
            "Also show the picture in the image viewer tev, which listens there (by default on port " +
                std::string(kTevPort) + ")")
        ->type_name("HOST:PORT");
}

TevPicture::TevPicture(const std::string& address, std::string name)
    : link_(address.empty() ? nullptr : std::make_unique<TevLink>(address)), name_(std::move(name)) {
    for (const FilmLayer& layer : kFilmLayers) {
        if (layer.files == FileRule::always) {
            for (std::string& channel : channel_names(layer)) {
                channels_.push_back(std::move(channel));
            }
        }
    }
}

template <typename Action>
void TevPicture::attempt(const Action& action) {
    if (link_ == nullptr) {
        return;
    }
    try {
        action();
    } catch (const Error& error) {
        spdlog::warn("{}; the picture is not sent to it any more, and the render goes on", error.what());
        link_.reset();
    }
}

void TevPicture::open(int width, int height) {
    next_row_ = 0;
    if (std::exchange(width_, width) == 0) {
        attempt([&] { link_->create(name_, width, height, channels_); });
    }
}

void TevPicture::add_rows(std::span<const float> rows) {
    attempt([&] {
        selected_.clear();
        for (std::size_t first = 0; first < rows.size(); first += NEARLIGHT_LAYER_CHANNELS) {
            for (const FilmLayer& layer : kFilmLayers) {
                if (layer.files == FileRule::always) {
                    const auto channels = rows.subspan(first + layer.first_channel, layer.channel_count);
                    selected_.insert(selected_.end(), channels.begin(), channels.end());
                }
            }
        }
        link_->update(name_, next_row_, width_, channels_, selected_);
        next_row_ += static_cast<int>(selected_.size() / channels_.size() / static_cast<std::size_t>(width_));
    });
}

}  // namespace nearlight::core
