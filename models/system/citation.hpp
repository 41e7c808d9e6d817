/// Published sources of the models: one entry each, shown as a line of text or as BibTeX.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// A publication. Fields that are not known, or do not apply, are empty.
struct Citation {
  enum class Kind { article, thesis, manuscript };
  std::string_view key;      ///< key of the BibTeX entry
  std::string_view authors;  ///< initials and family name of each author, with " and " between authors
  std::string_view title;
  std::string_view venue{};   ///< journal, or the university of a thesis
  std::string_view volume{};  ///< volume, with the issue in brackets
  std::string_view pages{};   ///< page range, or the article number
  std::string_view year{};
  std::string_view doi{};
  Kind kind = Kind::article;
};

/// A publication as one line of UTF-8: authors (year), title, venue volume, pages, DOI. A missing year is "n.d.".
[[nodiscard]] std::string citation_text(const Citation& citation);

/// A publication as a BibTeX entry in ASCII, with a line break at the end. Accented letters are TeX commands; empty
/// fields are left out.
[[nodiscard]] std::string bibtex(const Citation& citation);

/// Sources of the models.
namespace references {

extern const Citation k_agarwal2018;
extern const Citation k_biwa1995;
extern const Citation k_edmans;
extern const Citation k_hertz1882;
extern const Citation k_monograin;
extern const Citation k_nezamabadi2022;
extern const Citation k_shahin2021;
extern const Citation k_storakers1997;
extern const Citation k_zunker2024;
extern const Citation k_zunker2024b;

}  // namespace references

}  // namespace monograin
