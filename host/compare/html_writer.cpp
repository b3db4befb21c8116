// SPDX-License-Identifier: Apache-2.0
#include "host/compare/html_writer.h"

#include <algorithm>
#include <cstdint>

#include "host/base/files.h"

namespace nearlight::core {
namespace {

/// Whether the element starts a new line of the source, which keeps the page readable.
bool is_block(const std::string& tag) {
    constexpr std::string_view kInline[] = {"b", "span", "code", "td", "th", "a"};
    return std::ranges::find(kInline, tag) == std::end(kInline);
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string base64(std::string_view bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8u | (j < count ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += j <= count ? kDigits[group >> (18u - 6u * j) & 63u] : '=';
        }
    }
    return text;
}

HtmlWriter::HtmlWriter(const std::string& title, std::string_view style) {
    html_ = "<!DOCTYPE html>\n";
    open("html", {{"lang", "en"}}).open("head");
    tag("meta", {{"charset", "utf-8"}});
    tag("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
    element("title", title);
    html_ += "<style>\n" + std::string(style) + "</style>\n";
    close().open("body");
}

void HtmlWriter::tag(const std::string& name, const HtmlAttributes& attributes) {
    html_ += "<" + name;
    for (const auto& [attribute, value] : attributes) {
        html_ += " " + attribute + "=\"" + escaped(value) + "\"";
    }
    html_ += ">";
}

HtmlWriter& HtmlWriter::open(const std::string& name, const HtmlAttributes& attributes) {
    tag(name, attributes);
    open_.push_back(name);
    return *this;
}

HtmlWriter& HtmlWriter::close() {
    const std::string name = std::move(open_.back());
    open_.pop_back();
    html_ += "</" + name + ">" + (is_block(name) ? "\n" : "");
    return *this;
}

HtmlWriter& HtmlWriter::text(std::string_view text) {
    html_ += escaped(text);
    return *this;
}

HtmlWriter& HtmlWriter::element(const std::string& name, std::string_view content,
                                const HtmlAttributes& attributes) {
    return open(name, attributes).text(content).close();
}

HtmlWriter& HtmlWriter::markup(std::string_view markup) {
    html_ += markup;
    return *this;
}

HtmlWriter& HtmlWriter::image(const std::filesystem::path& file, const std::string& media_type,
                              const std::string& description, HtmlAttributes attributes) {
    attributes.insert(
        attributes.begin(),
        {{"src", "data:" + media_type + ";base64," + base64(read_bytes(file))}, {"alt", description}});
    tag("img", attributes);
    return *this;
}

std::string HtmlWriter::finish() {
    while (!open_.empty()) {
        close();
    }
    return std::move(html_);
}

}  // namespace nearlight::core
