#pragma once

// The library's literal ""_json is a plain function that calls its parser: whoever reads the header compiles the parser, a third of a
// second, whether he parses or not. Nobody writes such literals here, so the function becomes a template that nobody asks for. Where
// a version of the library writes it differently, it is read as it is.
#define JSON_USE_GLOBAL_UDLS 0
#define _json(text, size) _unparsed(const char*, std::size_t) = delete; template <class Text> nlohmann::json Literal(Text s, std::size_t n)
#include <nlohmann/json.hpp>
#undef _json
