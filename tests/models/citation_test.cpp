#include "system/citation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "catalogue.hpp"

namespace monograin::citation_test {
namespace {

constexpr Citation k_article{.key = "doe1999",
                             .authors = "J. Doe and K. Åberg and M. Störk",
                             .title = "On FEM",
                             .venue = "Journal",
                             .volume = "7(2)",
                             .pages = "11-19",
                             .year = "1999",
                             .doi = "10.1/x(1)"};

TEST(Citation, ShowsAnArticleInALine) {
  EXPECT_EQ(citation_text(k_article),
            "J. Doe, K. Åberg and M. Störk (1999), On FEM, Journal 7(2), 11-19, doi:10.1/x(1)");
}

TEST(Citation, ShowsAManuscriptWithoutAYear) {
  const Citation manuscript{.key = "doe",
                            .authors = "J. Doe",
                            .title = "On sand",
                            .venue = {},
                            .volume = {},
                            .pages = {},
                            .year = {},
                            .doi = {},
                            .kind = Citation::Kind::manuscript};
  EXPECT_EQ(citation_text(manuscript), "J. Doe (n.d.), On sand");
  EXPECT_EQ(bibtex(manuscript), "@misc{doe,\n  author = {J. Doe},\n  title = {{On sand}},\n  note = {n.d.}\n}\n");
}

TEST(Citation, ShowsAThesisWithItsUniversity) {
  const Citation thesis{.key = "roe2001",
                        .authors = "R. Roe",
                        .title = "On salt",
                        .venue = "A University",
                        .volume = {},
                        .pages = {},
                        .year = "2001",
                        .doi = {},
                        .kind = Citation::Kind::thesis};
  EXPECT_EQ(citation_text(thesis), "R. Roe (2001), On salt, M.Sc. thesis, A University");
  EXPECT_EQ(bibtex(thesis),
            "@mastersthesis{roe2001,\n  author = {R. Roe},\n  title = {{On salt}},\n  school = {A University},\n"
            "  year = {2001}\n}\n");
}

TEST(Citation, WritesAnArticleAsBibTex) {
  EXPECT_EQ(bibtex(k_article),
            "@article{doe1999,\n  author = {J. Doe and K. {\\AA}berg and M. St{\\\"o}rk},\n  title = {{On FEM}},\n"
            "  journal = {Journal},\n  volume = {7},\n  number = {2},\n  pages = {11--19},\n  year = {1999},\n"
            "  doi = {10.1/x(1)}\n}\n");
}

/// True if every closing brace follows its opening one, and no brace stays open.
bool has_balanced_braces(std::string_view text) {
  int depth = 0;
  for (const char c : text) {
    depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (depth < 0) return false;
  }
  return depth == 0;
}

TEST(Citation, OfEveryModelIsThere) {
  for (const Model& model : model_catalogue()) EXPECT_FALSE(model.references.empty()) << model.name;
}

TEST(Citation, OfEveryModelIsWellFormedBibTex) {
  std::map<std::string_view, const Citation*> by_key;
  for (const Model& model : model_catalogue()) {
    for (const Citation* reference : model.references) {
      const std::string entry = bibtex(*reference);
      EXPECT_TRUE(has_balanced_braces(entry)) << entry;
      EXPECT_TRUE(std::ranges::all_of(entry, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); })) << entry;
      EXPECT_FALSE(reference->key.empty() || reference->authors.empty() || reference->title.empty()) << entry;
      EXPECT_EQ(by_key.emplace(reference->key, reference).first->second, reference) << "two entries: " << entry;
    }
  }
}

}  // namespace
}  // namespace monograin::citation_test
