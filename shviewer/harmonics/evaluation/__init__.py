"""How the basis is numbered and evaluated; what others call of it is in basis.py."""
