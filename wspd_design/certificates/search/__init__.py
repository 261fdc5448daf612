"""The untrusted searches: branch and bound, linear matrix inequalities, sampled sets."""
