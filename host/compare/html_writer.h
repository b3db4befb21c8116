// SPDX-License-Identifier: Apache-2.0
// HTML with everything escaped and every element closed.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nearlight::core {

using HtmlAttributes = std::vector<std::pair<std::string, std::string>>;

class HtmlWriter {
  public:
    /// Starts a page with a title and a style sheet, which must not hold "</".
    HtmlWriter(const std::string& title, std::string_view style);

    HtmlWriter& open(const std::string& tag, const HtmlAttributes& attributes = {});
    /// Ends the element that was opened last.
    HtmlWriter& close();
    HtmlWriter& text(std::string_view text);
    /// An element with nothing but text in it.
    HtmlWriter& element(const std::string& tag, std::string_view text, const HtmlAttributes& attributes = {});
    /// The file itself becomes part of the page. `media_type` as "image/png".
    HtmlWriter& image(const std::filesystem::path& file, const std::string& media_type,
                      const std::string& description, HtmlAttributes attributes = {});

    /// Ends all that is open. The page is complete then.
    [[nodiscard]] std::string finish();

  private:
    void tag(const std::string& name, const HtmlAttributes& attributes);

    std::string html_;
    std::vector<std::string> open_;
};

/// For text and attribute values.
std::string escaped(std::string_view text);
/// [RFC 4648]
std::string base64(std::string_view bytes);

}  // namespace nearlight::core
