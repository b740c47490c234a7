"""The paper's results computed again, examined and improved on: one function per experiment."""
