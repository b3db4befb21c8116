// SPDX-License-Identifier: Apache-2.0
#include "nearlight/tev.h"

#include <map>

#include "host/image/tev_link.h"
#include "host/library/checks.h"
#include "nearlight/error.h"

namespace nearlight {

struct TevLink::State {
    explicit State(const std::string& address) : link(address) {}

    core::TevLink link;
    std::map<std::string, Image> shown;  ///< pictures that tev has, without their values
};

TevLink::TevLink(const std::string& address) : state_(std::make_unique<State>(address)) {}
TevLink::~TevLink() = default;
TevLink::TevLink(TevLink&&) noexcept = default;
TevLink& TevLink::operator=(TevLink&&) noexcept = default;

void TevLink::show(const std::string& name, const Image& image) {
    const std::string problem = "cannot show '" + name + "'";
    if (image.width < 1 || image.height < 1 || image.channels.empty()) {
        throw Error(ErrorKind::invalid_argument,
                    problem + ": an image needs at least one pixel and one channel");
    }
    check_values(problem, image);
    const auto known = state_->shown.find(name);
    if (known == state_->shown.end() || known->second.width != image.width ||
        known->second.height != image.height || known->second.channels != image.channels) {
        state_->link.create(name, image.width, image.height, image.channels);
        state_->shown.insert_or_assign(
            name, Image{.width = image.width, .height = image.height, .channels = image.channels});
    }
    state_->link.update(name, 0, image.width, image.channels, image.values);
}

}  // namespace nearlight
