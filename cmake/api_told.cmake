# Says where the API reference is, and how much of it has no comment.
file(STRINGS ${LIST} warnings REGEX "is not documented")
list(LENGTH warnings count)
message("${PAGES}: open it with a browser. ${count} public things have no comment: ${LIST}")
