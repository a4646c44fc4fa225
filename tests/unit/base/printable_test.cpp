// Escaping of foreign text in messages.
#include "base/printable.hpp"

#include "support/catch.hpp"

namespace scree {

TEST_CASE("printable text is unchanged") {
  for (const std::string text : {"", "a b/c \"\\", "\u00e4 \u7c92\u5b50 \U0001f4a5", "\u00a0"})
    CHECK(printable(text) == text);
}

TEST_CASE("control characters, other encodings and bidirectional controls are escaped") {
  CHECK(printable("a\nb\tc") == "a\\nb\\tc");
  CHECK(printable(std::string_view("\x1b[31m\x7f\0", 7)) == "\\x1b[31m\\x7f\\x00");
  CHECK(printable("\xe4 \xc3") == "\\xe4 \\xc3");                  // Latin-1; cut off
  CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");                    // an overlong encoding of "/"
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half of a surrogate pair
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond the last code point
  CHECK(printable("\u0085\u202e\ufeff") == "\\u0085\\u202e\\ufeff");
}

TEST_CASE("a long text loses its middle") {
  CHECK(shortened("0123456789", 10) == "0123456789");
  CHECK(shortened("0123456789a", 10) == "01234 ... 6789a");
  CHECK(shortened("\u00e4\u00e4\u00e4\u00e4\u00e4", 6) == "\u00e4 ... \u00e4");  // whole characters
}

}  // namespace scree
