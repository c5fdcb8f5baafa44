"""The results of ctest, as 'ctest --output-junit' writes them."""
import xml.etree.ElementTree


def results_of(file):
    """By the name of a test, without what follows it of its parameter."""
    tests = xml.etree.ElementTree.parse(file).getroot().iter("testcase")
    return {test.get("name").split("  #")[0]: test for test in tests}


def is_skipped(test):
    """By its own word. One that could not be run is not."""
    return any((skipped.get("message") or "").startswith("SKIP_") for skipped in test.iter("skipped"))


def is_failed(test):
    return test.get("status") == "fail" or test.get("status") == "notrun" and not is_skipped(test)
