/* Reset, faults, the emulator's services, and what C cannot say. */

    .section .reset, "ax"
    .global reset
reset:
    j       begin

    /* VECBASE points here: kernel, user and double exception of the lx106. */
    .balign 256
vectors:
    .org    vectors + 0x30
    j       faulted
    .org    vectors + 0x50
    j       faulted
    .org    vectors + 0x70
    j       faulted

    .literal_position
    .balign 4
begin:
    movi    a1, stack_top
    movi    a2, vectors
    wsr     a2, vecbase
    movi    a2, 0
    wsr     a2, ps              /* exceptions go to their vectors */
    rsync
    call0   main
    call0   board_exit

    .balign 4
faulted:
    movi    a1, stack_top
    rsr     a2, exccause
    rsr     a3, epc1
    call0   board_fault

    .text
    .literal_position

/* void board_exit(int status) */
    .global board_exit
    .type board_exit, @function
    .balign 4
board_exit:
    mov     a3, a2
    movi    a2, 1
    simcall

/* void board_write(const char *text, size_t n) */
    .global board_write
    .type board_write, @function
    .balign 4
board_write:
    mov     a5, a3
    mov     a4, a2
    movi    a3, 1               /* standard output */
    movi    a2, 4
    simcall
    ret

/* void stack_call(uint32_t *top, const stack_call_t *call): calls a function
 * of four arguments on a stack of its own, which ends below `top`. */
    .global stack_call
    .type stack_call, @function
    .balign 4
stack_call:
    s32i    a0, a2, 0
    s32i    a1, a2, 4
    mov     a1, a2
    l32i    a7, a3, 0
    l32i    a2, a3, 4
    l32i    a5, a3, 16
    l32i    a4, a3, 12
    l32i    a3, a3, 8
    callx0  a7
    l32i    a0, a1, 0
    l32i    a1, a1, 4
    ret

/* uint32_t ticks_of_loop(uint32_t rounds): two instructions a round. */
    .global ticks_of_loop
    .type ticks_of_loop, @function
    .balign 4
ticks_of_loop:
    rsr     a3, ccount
1:  addi    a2, a2, -1
    bnez    a2, 1b
    rsr     a2, ccount
    sub     a2, a2, a3
    ret

/* uint32_t ticks_of_10000_nops(void): straight on, without a branch. */
    .global ticks_of_10000_nops
    .type ticks_of_10000_nops, @function
    .balign 4
ticks_of_10000_nops:
    rsr     a3, ccount
    .rept   10000
    nop
    .endr
    rsr     a2, ccount
    sub     a2, a2, a3
    ret
