"""Small motions about a state: modes, their shapes, and the response to what excites them."""
