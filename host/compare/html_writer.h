// SPDX-License-Identifier: Apache-2.0
// Writes HTML in which all text is escaped and every element is closed.
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
    /// Starts a page with a title and a style sheet, which must not contain "</".
    HtmlWriter(const std::string& title, std::string_view style);

    HtmlWriter& open(const std::string& tag, const HtmlAttributes& attributes = {});
    /// Ends the element that was opened last.
    HtmlWriter& close();
    HtmlWriter& text(std::string_view text);
    /// Adds an element that contains only text.
    HtmlWriter& element(const std::string& tag, std::string_view text, const HtmlAttributes& attributes = {});
    /// Adds markup that is complete in itself, as it is.
    HtmlWriter& markup(std::string_view markup);
    /// Embeds the contents of the file in the page. `media_type` is for example "image/png".
    HtmlWriter& image(const std::filesystem::path& file, const std::string& media_type,
                      const std::string& description, HtmlAttributes attributes = {});

    /// Closes all open elements and returns the complete page.
    [[nodiscard]] std::string finish();

  private:
    void tag(const std::string& name, const HtmlAttributes& attributes);

    std::string html_;
    std::vector<std::string> open_;
};

/// Escapes text for use in elements and attribute values.
std::string escaped(std::string_view text);
/// Encodes bytes as Base64 [RFC 4648].
std::string base64(std::string_view bytes);

}  // namespace nearlight::core
