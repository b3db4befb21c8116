// SPDX-License-Identifier: Apache-2.0
#include "host/ranks/message.h"

#include <gtest/gtest.h>

#include "host/ranks/hello.h"

namespace nearlight::core {
namespace {

TEST(Messages, ArriveAsTheyWereMade) {
    const std::vector<float> rows{1.5f, -2.0f, 0.0f};
    const std::vector<uint> more{7, 8};
    const Message sent({.kind = MessageKind::band,
                        .device = 2,
                        .picture = PictureNumber{1} << 40u,
                        .band = 11,
                        .fraction = 0.25,
                        .local_lights = 9},
                       {part_of(rows), part_of(more)});
    const Message received({sent.bytes().begin(), sent.bytes().end()});
    ASSERT_TRUE(received.is_whole());
    EXPECT_EQ(received.head().kind, MessageKind::band);
    EXPECT_EQ(received.head().device, 2u);
    EXPECT_EQ(received.head().picture, PictureNumber{1} << 40u);
    EXPECT_EQ(received.head().band, 11u);
    EXPECT_EQ(received.head().fraction, 0.25);
    EXPECT_EQ(received.head().local_lights, 9u);
    EXPECT_EQ(received.first<float>(), 1.5f);
    EXPECT_EQ(received.body<uint>(rows.size() * sizeof(float)), more);
}

TEST(Messages, NeedAHead) {
    EXPECT_FALSE(Message(std::vector<std::byte>(sizeof(MessageHead) - 1)).is_whole());
    const Message empty({.kind = MessageKind::end_job});
    EXPECT_TRUE(empty.is_whole());
    EXPECT_EQ(empty.text(), "");
}

TEST(Hellos, SayWhatARankHasOrLacks) {
    const Hello ready = parse_hello(to_text(
        {.host = "node7",
         .facts = R"({"scene": "1f"})",
         .devices = {{.number = 0, .name = "a", .batch_receivers = 64}, {.number = 1, .name = "b \xff"}}}));
    EXPECT_EQ(ready.host, "node7");
    EXPECT_EQ(ready.facts, R"({"scene": "1f"})");
    ASSERT_EQ(ready.devices.size(), 2u);
    EXPECT_EQ(ready.devices[0].batch_receivers, 64u);
    EXPECT_EQ(ready.devices[1].number, 1u);
    EXPECT_FALSE(ready.failure);
    const Hello lame = parse_hello(to_text(
        {.host = "node8", .facts = {}, .devices = {}, .failure = Error(ErrorKind::no_device, "no driver")}));
    ASSERT_TRUE(lame.failure);
    EXPECT_EQ(lame.failure->kind(), ErrorKind::no_device);
    EXPECT_STREQ(lame.failure->what(), "no driver");
}

TEST(Hellos, OfOtherProgramsAreRefusals) {
    for (const char* const text : {"", "hello", "{}", "[]", R"({"host": 1, "facts": "", "devices": []})"}) {
        const Hello hello = parse_hello(text);
        ASSERT_TRUE(hello.failure) << text;
        EXPECT_EQ(hello.failure->kind(), ErrorKind::invalid_argument);
    }
}

}  // namespace
}  // namespace nearlight::core
