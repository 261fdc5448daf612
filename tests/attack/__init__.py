"""Independent attacks: equations written from the paper, attackers of what is PROVED, and a forger of files."""
