// SPDX-License-Identifier: Apache-2.0
#include "host/scene/image_reader.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "host/base/thread_limit.h"
#include "host/image/image_io.h"

namespace nearlight::core {
namespace {

/// An image that waits takes 12 or 16 bytes a pixel, four times what its texture takes.
constexpr int kMaxAhead = 4;

Image read_source(const ImageSource& source) {
    return source.bytes ? read_image(*source.bytes, source.file.string()) : read_image(source.file);
}

}  // namespace

void ImageReader::expect(std::vector<ImageSource> sources) {
    for (ImageSource& source : sources) {
        if (std::find(expected_.begin(), expected_.end(), source) == expected_.end()) {
            expected_.push_back(std::move(source));
        }
    }
    read_ahead();
}

const Image& ImageReader::read(const ImageSource& source) {
    if (source == last_) {
        return image_;
    }
    last_.reset();
    image_ = take(source).get();
    last_ = source;
    return image_;
}

void ImageReader::read_ahead() {
    const std::size_t most = files_ahead(kMaxAhead);
    while (!expected_.empty() && ahead_.size() < most) {
        try {
            ahead_.push_back(
                {expected_.front(), std::async(std::launch::async, read_source, expected_.front())});
        } catch (const std::system_error&) {
            return;  // the system gives no more threads
        }
        expected_.pop_front();
    }
}

std::future<Image> ImageReader::take(const ImageSource& source) {
    const auto begun = std::find_if(ahead_.begin(), ahead_.end(),
                                    [&](const Ahead& ahead) { return ahead.source == source; });
    if (begun != ahead_.end()) {
        std::future<Image> image = std::move(begun->image);
        ahead_.erase(begun);
        read_ahead();
        return image;
    }
    const auto waiting = std::find(expected_.begin(), expected_.end(), source);
    if (waiting != expected_.end()) {
        expected_.erase(waiting);
        if (!ahead_.empty()) {
            ahead_.pop_front();  // it was passed over, and must not keep those behind it waiting
        }
        read_ahead();
    }
    return std::async(std::launch::deferred, read_source, source);
}

}  // namespace nearlight::core
