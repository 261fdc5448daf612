"""How records show themselves in a notebook: tables, cards of HTML, data frames."""
