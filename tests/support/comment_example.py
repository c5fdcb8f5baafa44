"""comment_example.py HEADER OUTPUT: the first example in the comments of a header, as source, for a test to compile.

An example is what stands between the first '///   class' and the '///   };' after it.
"""
import re
import sys

header, output = sys.argv[1:]
lines = open(header).read().split("\n")
begin = next(i for i, line in enumerate(lines) if line.startswith("///   class "))
end = next(i for i in range(begin, len(lines)) if lines[i] == "///   };")
with open(output, "w") as file:
    file.write("\n".join(re.sub(r"^///( {3})?", "", line) for line in lines[begin:end + 1]) + "\n")
